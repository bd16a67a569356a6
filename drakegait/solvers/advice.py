"""What to try when a solve did not converge."""

from __future__ import annotations

from collections.abc import Sequence

from drakegait.program.gait_program import Violation

_BALANCE = (
    "the muscles may be too weak or the motion too fast: try a speed nearer to the reference, more "
    "strength of the muscles across that joint, or a larger moment_tolerance"
)
_BY_LAW = {
    "equations of motion": _BALANCE,
    "least-squares contact forces": _BALANCE,
    "foot contact": "the feet cannot reach their footprints: try a speed nearer to the reference "
    "or a larger contact_tolerance",
    "clearance": "the swing foot has no room: check joint limits and the reference",
    "friction": "the ground is too slippery for this walk: raise friction or lower the speed",
    "free moment": "the foot twists more than the ground holds: raise friction or patch_radius",
    "excitation": "a muscle would have to switch faster or pull harder than it can: lower the "
    "speed, raise its strength, or use more nodes",
    "normal force": "the ground would have to pull: lower the speed",
    "joint limit": "a joint limit is too tight for this walk: widen it",
    "average speed": "this speed cannot be reached with these muscles, ground and ranges: "
    "change it or them; `drakegait explain` tells which helps",
    "phase duration": "a contact phase would vanish or grow too long: try a speed nearer to the "
    "reference",
}


def advice_for(status: str, worst: Sequence[Violation]) -> str:
    """One sentence about what to change; empty if converged."""
    if status == "converged":
        return ""
    if status in ("time_limit", "interrupted", "iteration_limit"):
        return "Continue from the saved gait (--guess) or allow more time."
    if not worst:
        return "Start from an earlier gait of a similar study (--guess), or use more nodes."
    law = worst[0].kind
    return f"Worst is {worst[0].name}: {_BY_LAW.get(law, 'try another starting gait')}."
