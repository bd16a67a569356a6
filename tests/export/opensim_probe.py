"""What OpenSim makes of exported files; run as a program of its own.

OpenSim and drakegait each bring a library of the same name (CasADi), so one process cannot hold
both. Reads `request.json` in the folder that is given, writes `answer.json` beside it.
"""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

import numpy as np
import opensim


class Probe:
    """A model in OpenSim, with its coordinates by name."""

    def __init__(self, path: Path):
        self.model = opensim.Model(str(path))
        self.state = self.model.initSystem()
        self.set = self.model.getCoordinateSet()
        states = opensim.createStateVariableNamesInSystemOrder(self.model)
        self.tree = [name.split("/")[-2] for name in states if name.endswith("/value")]

    def pose(self, names, q, v):
        for name, x, xdot in zip(names, q, v, strict=True):
            self.set.get(name).setValue(self.state, x, False)
            self.set.get(name).setSpeedValue(self.state, xdot)
        self.model.realizeVelocity(self.state)

    def mass_matrix(self, names):
        matrix = opensim.Matrix()
        self.model.getMatterSubsystem().calcM(self.state, matrix)
        place = [self.tree.index(name) for name in names]
        return matrix.to_numpy()[np.ix_(place, place)]

    def inverse_dynamics(self, names, a):
        """Generalised forces that the joints must supply besides the forces of the model."""
        ordered = opensim.Vector(len(names), 0.0)
        for i, name in enumerate(self.tree):
            ordered[i] = a[names.index(name)]
        forces = opensim.InverseDynamicsSolver(self.model).solve(self.state, ordered)
        return [forces[self.tree.index(name)] for name in names]

    def path(self, muscle, names):
        """Length and moment arms of one muscle."""
        force = self.model.getForceSet().get(muscle)
        path = opensim.FunctionBasedPath.safeDownCast(force.getComponent("path"))
        arms = [path.computeMomentArm(self.state, self.set.get(name)) for name in names]
        return path.getLength(self.state), arms

    def shape(self, path):
        """Place and upward axis of a picture, in the ground."""
        frame = opensim.PhysicalFrame.safeDownCast(self.model.getComponent(path))
        transform = frame.getTransformInGround(self.state)
        up = transform.R().asMat33()
        return [transform.p()[i] for i in range(3)] + [up.get(i, 1) for i in range(3)]

    def accelerations(self, names, controls):
        """Of forward dynamics, with controls of the actuators by name."""
        vector = self.model.updControls(self.state)
        order = opensim.createControlNamesFromModel(self.model)
        for i, name in enumerate(order):
            vector[i] = controls[name.split("/")[-1]]
        self.model.setControls(self.state, vector)
        self.model.realizeAcceleration(self.state)
        return [self.set.get(name).getAccelerationValue(self.state) for name in names]


def postures(request: dict) -> dict:
    """A model at postures with velocities and accelerations."""
    probe = Probe(request["model"])
    names, answer = request["names"], {key: [] for key in request["ask"]}
    answer["mass"] = probe.model.getTotalMass(probe.state)
    for k, (q, v) in enumerate(zip(request["q"], request["v"], strict=True)):
        probe.pose(names, q, v)
        if "mass_matrix" in answer:
            answer["mass_matrix"].append(probe.mass_matrix(names).tolist())
        if "paths" in answer:
            answer["paths"].append([probe.path(muscle, names) for muscle in request["muscles"]])
        if "forces" in answer:
            answer["forces"].append(probe.inverse_dynamics(names, request["a"][k]))
        if "accelerations" in answer:
            controls = dict(zip(request["muscles"], request["controls"][k], strict=True))
            answer["accelerations"].append(probe.accelerations(names, controls))
        if "shapes" in answer:
            answer["shapes"].append([probe.shape(path) for path in request["shapes"]])
        if "points" in answer:
            markers = probe.model.getMarkerSet()
            places = [markers.get(name).getLocationInGround(probe.state)
                      for name in ("heel_r", "toe_r", "heel_l", "toe_l")]  # fmt: skip
            answer["points"].append([[place[i] for i in range(3)] for place in places])
    return answer


def files(request: dict) -> dict:
    """Every table read in both of OpenSim's ways, and its inverse dynamics of the motion."""
    answer = {}
    for name in request["tables"]:
        table, old = opensim.TimeSeriesTable(name), opensim.Storage(name)
        answer[name] = [table.getNumRows(), list(table.getColumnLabels()), old.getSize()]
    assert opensim.InverseDynamicsTool("inverse_dynamics.xml").run()
    moments = opensim.TimeSeriesTable("inverse_dynamics.sto")
    answer["time"] = list(moments.getIndependentColumn())
    answer["moments"] = {
        label: moments.getDependentColumn(label).to_numpy().tolist()
        for label in moments.getColumnLabels()
    }
    model = opensim.Model("model.osim")
    model.initSystem()
    states = opensim.TimeSeriesTable("states.sto")
    opensim.StatesTrajectory.createFromStatesTable(model, states)  # raises if one is missing
    return answer


def main() -> None:
    opensim.Logger.setLevelString("error")
    os.chdir(sys.argv[1])
    request = json.loads(Path("request.json").read_text(encoding="utf-8"))
    answer = {"postures": postures, "files": files}[request["what"]](request)
    Path("answer.json").write_text(json.dumps(answer), encoding="utf-8")


if __name__ == "__main__":
    main()
