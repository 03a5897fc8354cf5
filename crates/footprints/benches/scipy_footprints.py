"""Minimises the energy of exported footprints with scipy's L-BFGS-B and prints one JSON line per case.

Usage: python3 scipy_footprints.py PROBLEM.json

The file is written by benches/footprints.rs: for every sample of every curve the weights of its knots' numbers, the time it
stands for and the feet on the ground (two at most, absent ones with weight 0).  The energy and its gradient are computed for all
samples at once, and checked against those of the Rust side at random points before any clock starts.  The clock stops when the
energy is first within `near` (relative) of that of the Rust side's solution, which spares scipy the time it needs to notice that
it has converged.
"""

import json
import sys
import time

import numpy as np
from scipy.optimize import minimize

GRAVITY = np.array([0.0, -9.81, 0.0])
FLAT = 1e-10
NO_PULL = -1e-12
MOST_EVALUATIONS = 20_000
RUNS = 3


class Reached(Exception):
    """The energy is near enough to the known one."""


def direction(vectors):
    """Unit vectors and lengths."""
    lengths = np.sqrt(np.einsum("fcsd,fcsd->fcs", vectors, vectors))
    return vectors / np.where(lengths > 0.0, lengths, 1.0)[..., None], lengths


class Footprints:
    """Energy and gradient by all knots' places and velocities."""

    def __init__(self, file):
        p = json.load(file)
        self.near = p["near"]
        self.optimum = p["optimum"]
        self.start = np.array(p["start"])
        self.checks = p["checks"]
        self.stages = p["stages"]
        self.physics, self.comfort = p["weights"]["physics"], p["weights"]["comfort_per_s2"]
        self.toe_band = p["weights"]["toe_band_m"]
        # Curves, samples, the four numbers of two knots.
        self.place, self.acceleration = np.array(p["place"]), np.array(p["acceleration"])
        self.lasts = np.array(p["lasts_s"])
        # Feet, curves, samples (, axes).
        self.down = np.array(p["down"])
        self.ankle, self.middle, self.toe = (np.array(p[key]) for key in ("ankle", "middle", "toe_from_middle"))
        self.hip, self.through = np.array(p["hip"]), np.array(p["through"])
        self.nominal, self.longest = np.array(p["nominal_m"]), np.array(p["longest_m"])
        self.tip = self.middle + self.toe
        self.lever = direction(self.ankle - self.tip)[1]

    def on_toes(self, length):
        """The leg's length, which grows no more once the heel rises; the toe's share of the support, and its rate."""
        beyond = length - self.longest
        if self.toe_band > 0.0:
            x = np.clip(beyond / self.toe_band, 0.0, 1.0)
        else:
            x = (beyond > 0.0).astype(float)
        square = x * x
        shown = np.minimum(length, self.longest) + self.toe_band * (x - square * x + 0.5 * square * square)
        rate = 6.0 * (x - square) / self.toe_band if self.toe_band > 0.0 else np.zeros_like(x)
        return shown, 3.0 * square - 2.0 * square * x, rate

    def legs(self, centre):
        """Along the leg, how much too long it is and how much that gives; the direction of its force, the distance to the
        support and how fast the toe takes over; from the toe, and how far the hip is out of reach from there."""
        along, length = direction(centre + self.hip - self.ankle)
        shown, share, rate = self.on_toes(length)
        force, distance = direction(centre + self.through - self.middle - share[..., None] * self.toe)
        from_toe, toe_length = direction(centre + self.hip - self.tip)
        beyond = np.maximum(toe_length - self.lever - self.longest, 0.0) * self.down
        return along, (shown - self.nominal) * self.down, 1.0 - share, force, distance, rate, from_toe, beyond

    def forces(self, required, direction):
        """How much each foot pushes so that least is missing."""
        along = np.einsum("csd,fcsd->fcs", required, direction) * self.down
        single = np.maximum(along, 0.0)
        first_only = single[0] >= single[1]
        forces = np.stack((np.where(first_only, single[0], 0.0), np.where(first_only, 0.0, single[1])))
        between = np.einsum("csd,csd->cs", direction[0], direction[1])
        area = 1.0 - between * between
        both = np.stack((along[0] - between * along[1], along[1] - between * along[0])) / np.where(area > FLAT, area, 1.0)
        use_both = (area > FLAT) & (both >= NO_PULL).all(axis=0) & (self.down > 0).all(axis=0)
        return np.where(use_both, both, forces)

    def energy_and_gradient(self, x, smoothing=0.0):
        knots = x.reshape(-1, 2, 3)
        ends = np.concatenate((knots[:-1], knots[1:]), axis=1)
        centre = np.einsum("csk,ckd->csd", self.place, ends)
        required = np.einsum("csk,ckd->csd", self.acceleration, ends) - GRAVITY
        along, longer, gives, force, distance, rate, from_toe, beyond = self.legs(centre)
        forces = self.forces(required, force)
        missing = required - np.einsum("fcs,fcsd->csd", forces, force)
        size = np.sqrt(np.einsum("csd,csd->cs", missing, missing) + smoothing * smoothing)
        energy = self.physics * np.sum(size * self.lasts)
        energy += self.comfort * np.sum((longer * longer + beyond * beyond) * self.lasts)

        by_acceleration = self.physics * missing * (self.lasts / np.maximum(size, 1e-300))[..., None]
        # The transpose of (I - d d') / distance (I - toe along') f, on -by_acceleration.
        scaled = forces / np.maximum(distance, 1e-6)
        on_force = np.einsum("csd,fcsd->fcs", by_acceleration, force)
        across = (by_acceleration - on_force[..., None] * force) * scaled[..., None]
        on_toe = np.einsum("fcsd,fcsd->fcs", across, self.toe) * rate
        by_place = np.sum(on_toe[..., None] * along - across, axis=0)
        twice = 2.0 * self.comfort * self.lasts
        by_place += np.einsum("fcs,fcsd->csd", twice * longer * gives, along)
        by_place += np.einsum("fcs,fcsd->csd", twice * beyond, from_toe)
        by_ends = np.einsum("csk,csd->ckd", self.place, by_place)
        by_ends += np.einsum("csk,csd->ckd", self.acceleration, by_acceleration)
        gradient = np.zeros_like(knots)
        gradient[:-1] += by_ends[:, :2]
        gradient[1:] += by_ends[:, 2:]
        return energy, gradient.ravel()


def check(problem):
    """The same energy and gradient as the other side, at its random points."""
    for at in problem.checks:
        energy, gradient = problem.energy_and_gradient(np.array(at["knots"]))
        wanted = np.array(at["gradient"])
        assert abs(energy - at["energy"]) <= 1e-9 * at["energy"], f"energy {energy}, not {at['energy']}"
        off = np.max(np.abs(gradient - wanted)) / np.max(np.abs(wanted))
        assert off <= 1e-9, f"the gradient is off by {off}"


def run(problem, stages, options):
    """One run: seconds until near enough (or its end), least energy, evaluations; watching the energy is not timed."""
    best, evaluations, watching = np.inf, 0, 0.0
    begin = time.perf_counter()

    def watched(x, smoothing):
        nonlocal best, evaluations, watching
        energy, gradient = problem.energy_and_gradient(x, smoothing)
        evaluations += 1
        if smoothing > 0.0:
            at = time.perf_counter()
            best = min(best, problem.energy_and_gradient(x)[0])
            watching += time.perf_counter() - at
        else:
            best = min(best, energy)
        if best <= problem.optimum * (1.0 + problem.near):
            raise Reached
        return energy, gradient

    x, is_near = problem.start, False
    try:
        for smoothing in stages:
            x = minimize(watched, x, args=(smoothing,), jac=True, method="L-BFGS-B", options=options).x
    except Reached:
        is_near = True
    return time.perf_counter() - begin - watching, best, evaluations, is_near


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        problem = Footprints(file)
    check(problem)
    thorough = {"maxiter": MOST_EVALUATIONS, "maxfun": MOST_EVALUATIONS, "ftol": 1e-12, "gtol": 1e-10}
    cases = [
        ("its defaults", [0.0], {}),
        ("thorough, 30 corrections", [0.0], thorough | {"maxcor": 30}),
        ("rounded in stages, 30 corrections", [*problem.stages, 0.0], thorough | {"maxcor": 30, "ftol": 1e-7}),
    ]
    for case, stages, options in cases:
        runs = sorted(run(problem, stages, options) for _ in range(RUNS))
        seconds, best, evaluations, is_near = runs[len(runs) // 2]
        line = {"case": case, "seconds": seconds, "energy": best, "evaluations": evaluations, "near": bool(is_near)}
        print(json.dumps(line), flush=True)


main()
