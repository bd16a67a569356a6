"""A first walk: from a question to a gait that can be looked at.

How does a person of 1.70 m and 65 kg walk at 1.2 m/s? We state who walks and how fast; the walk
itself is found: joint angles, muscle forces, contact forces, timing and foot placement are the
unknowns of one optimisation that weighs metabolic energy against the deviation from a measured
stride. The walker of this example moves in the sagittal plane, with legs that are independent of
each other; replace `planar` by `spatial` for three dimensions, and wait some minutes.

    python examples/first_walk.py [FOLDER]
"""

import sys
from pathlib import Path

from drakegait import GaitStudy, Subject, plot, replay, solve

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out/first_walk")
folder.mkdir(parents=True, exist_ok=True)

# 1. The study: a list of physical statements. What is not said has a default.
study = GaitStudy.planar(
    nodes=18,  # of the splines, per stride
    speed=1.2,  # [m/s]
    subject=Subject(height=1.70, mass=65.0),  # [m], [kg]
)

# 2. The solve. Ctrl-C would end it with the best gait so far.
gait = solve(
    study,
    report=lambda now: print(f"\riteration {now.iteration}, cost {now.cost:.4g}   ", end=""),
)
print(f"\n{gait.outcome.status}: {gait.outcome.message}")
if not gait.converged:
    print("\n".join(gait.outcome.worst), gait.outcome.advice, sep="\n")

# 3. The answer in numbers. The check judges the gait between the control points, where the
#    optimisation did not look.
print(f"step lengths  {gait.placement.step_length_right:.3f} and "
      f"{gait.placement.step_length_left:.3f} m")  # fmt: skip
print(f"cadence       {120.0 / gait.stride_time:.1f} steps/min")
print(f"energy        {gait.metabolic.cost_of_transport:.0f} J/m")
print(f"check         {'passed' if gait.report.passed else 'NOT passed'}")

# 4. The answer as curves: labelled arrays over the gait cycle, angles in degrees.
curves = gait.sample(101)
knee = curves.coordinates.sel(coordinate="knee_flexion_r")
soleus = curves.activation.sel(muscle="soleus_r")
print(f"knee flexion  up to {float(knee.max()):.0f} degrees")
print(f"soleus        up to {float(soleus.max()):.2f} active, at {soleus.values.argmax()} % "
      "of the cycle")  # fmt: skip

# 5. The answer on disk: a file that stands alone, figures, and a recording for the browser.
gait.save(folder / "gait.nc")
plot(gait, folder / "figures")
replay(gait, html=folder / "replay.html")
print(f"look into {folder}")
