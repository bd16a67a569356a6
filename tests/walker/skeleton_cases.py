"""States, differences and an independent model for the tests of the skeleton."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from drakegait.walker import coordinates
from drakegait.walker.skeleton import Skeleton


def state(skeleton: Skeleton, seed: int = 0, count: int | None = None) -> tuple[np.ndarray, ...]:
    """Random q, v, a of a size that walking does not reach."""
    rng = np.random.default_rng(seed)
    lead = () if count is None else (count,)
    return tuple(rng.normal(scale=s, size=(*lead, skeleton.num_coordinates)) for s in (0.5, 2, 9))


def differences(function, q: np.ndarray, h: float = 1e-6) -> np.ndarray:
    """Central differences of `function` by each coordinate, as the last axis."""
    columns = [(function(q + h * e) - function(q - h * e)) / (2 * h) for e in np.eye(len(q))]
    return np.stack(columns, axis=-1)


def pinocchio_model(kind: str):
    """The skeleton joint by joint from the numbers of the table, not from the SDF; our order."""
    model = pin.Model()
    model.gravity.linear = np.array([0.0, 0.0, -9.81])
    joints = {
        "x": pin.JointModelPX, "y": pin.JointModelPY, "z": pin.JointModelPZ,
        "a": pin.JointModelRX, "b": pin.JointModelRY, "g": pin.JointModelRZ,
    }  # fmt: skip
    place = pin.SE3.Identity
    bodies = {
        "hat": (50.85, (0, 0, 0.315504), (3.721, 3.178, 0.815)),
        "thigh": (7.5, (0, 0, -0.190953), (0.1522, 0.1522, 0.0312)),
        "shank": (3.4875, (0, 0, -0.1917324), (0.0649, 0.0624, 0.0107)),
        "foot": (1.0875, (0.0768, 0, -0.0351), (0.00125, 0.00489, 0.00538)),
    }

    def chain(parent, symbols, at):
        for symbol in symbols:
            if kind == "planar" and symbol[0] not in "xzb":
                continue
            parent = model.addJoint(parent, joints[symbol[0]](), at, symbol)
            at = place()
        return parent

    def body(joint, name):
        mass, com, inertia = bodies[name]
        inertia = pin.Inertia(mass, np.array(com, float), np.diag(inertia))
        model.appendBodyToJoint(joint, inertia, place())

    hat = chain(0, ["x_I1", "y_I1", "z_I1", "b_I1", "a_I1", "g_I1"], place())
    body(hat, "hat")
    for side, (hip, knee, ankle) in ((-1, ("13", "34", "45")), (1, ("16", "67", "78"))):
        at = pin.SE3(np.eye(3), np.array([0.0, side * 0.0835, 0.0]))
        thigh = chain(hat, [f"{s}_{hip}" for s in "bag"], at)
        body(thigh, "thigh")
        shank = chain(thigh, [f"b_{knee}"], pin.SE3(np.eye(3), np.array([0.0, 0.0, -0.441])))
        body(shank, "shank")
        foot = chain(shank, [f"b_{ankle}"], pin.SE3(np.eye(3), np.array([0.0, 0.0, -0.4428])))
        body(foot, "foot")
        for name, x in (("heel", -0.06), ("toe", 0.142)):
            at = pin.SE3(np.eye(3), np.array([x, 0.0, -0.0702]))
            model.addFrame(pin.Frame(f"{name}_{'r' if side < 0 else 'l'}", foot, at, pin.OP_FRAME))
    symbols = list(model.names)[1:]
    order = [symbols.index(c.paper_name) for c in coordinates.coordinates(kind)]
    return model, np.array(order)
