"""Solves an exported stride problem with scipy.optimize.least_squares and prints one JSON line per case.

Usage: python3 scipy_reference.py PROBLEM.json

The form of the file is described in crates/fitting/src/export_problem.rs.  The clock stops when the cost is first
within 1e-6 (relative) of the optimum in the file, which spares scipy the time it needs to notice that it has converged.
"""

import json
import sys
import time

import numpy as np
import scipy.sparse as sp
from scipy.optimize import least_squares

NEAR = 1e-6
MAX_EVALUATIONS = 300


class Reached(Exception):
    """The cost is near enough to the known optimum."""


def matrix(triplets, shape):
    entries = (triplets["values"], (triplets["rows"], triplets["columns"]))
    return sp.csr_matrix(entries, shape=shape)


def products(a, m, offset):
    """Entries of a @ diag(w) @ m for any w, as (row, column, index into w, coefficient)."""
    a, m = a.tocoo(), m.tocsr()
    counts = np.diff(m.indptr)[a.col]
    of_a = np.repeat(np.arange(a.nnz), counts)
    within = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    of_m = m.indptr[a.col][of_a] + within
    return a.row[of_a], m.indices[of_m], a.col[of_a] + offset, a.data[of_a] * m.data[of_m]


class StrideProblem:
    """Residuals and their exact sparse Jacobian, both from a few sparse products."""

    def __init__(self, file):
        p = json.load(file)
        n, k, m = p["unknowns"], p["terms"], p["residuals"]
        self.shape = (m, n)
        self.log_length = matrix(p["log_length"], (k, n))
        self.slide = matrix(p["slide"], (k, n))
        self.direction = matrix(p["direction"], (k, n))
        self.along, self.up = matrix(p["along"], (m, k)), matrix(p["up"], (m, k))
        self.linear = matrix(p["linear"], (m, n))
        self.length_m = np.array(p["length_m"])
        self.direction_offset = np.array(p["direction_offset_rad"])
        self.constant = np.array(p["constant"])
        self.robust = np.array(p["is_robust"])
        self.cauchy = p["cauchy"]
        self.start = np.array(p["start"])
        self.is_bounded = p["lower"] is not None
        self.bounds = (-np.inf, np.inf)
        if self.is_bounded:
            # The root's bounds are never met; left infinite they do not spoil scipy's scaling by the distance to them.
            sides = (np.array(p["lower"]), np.array(p["upper"]))
            self.bounds = tuple(np.where(np.abs(side) < 1e3, side, np.sign(side) * np.inf) for side in sides)
        self.optimum_cost = p["optimum_cost"]
        self.prepare_jacobian(k)

    def prepare_jacobian(self, k):
        """The Jacobian's data are linear in six numbers per term; the pattern is worked out once."""
        parts = []
        for side, a in enumerate((self.along, self.up)):
            parts.append(products(a, self.log_length, (0 + side) * k))
            parts.append(products(a, self.slide, (2 + side) * k))
            parts.append(products(a, self.direction, (4 + side) * k))
        rows, columns, weights, values = (np.concatenate(v) for v in zip(*parts))
        fixed = self.linear.tocoo()
        keys = np.concatenate((rows, fixed.row)).astype(np.int64) * self.shape[1]
        keys += np.concatenate((columns, fixed.col))
        places, at = np.unique(keys, return_inverse=True)
        self.indices = (places % self.shape[1]).astype(np.int32)
        self.row_of = (places // self.shape[1]).astype(np.int32)
        self.indptr = np.searchsorted(self.row_of, np.arange(self.shape[0] + 1)).astype(np.int32)
        self.from_terms = sp.csr_matrix((values, (at[: len(rows)], weights)), shape=(len(places), 6 * k))
        self.fixed = np.bincount(at[len(rows) :], fixed.data, len(places))

    def terms(self, x):
        stretched = self.length_m * np.exp(self.log_length @ x)
        directions = self.direction @ x + self.direction_offset
        return stretched, stretched + self.slide @ x, np.cos(directions), np.sin(directions)

    def raw(self, x):
        _, lengths, cos, sin = self.terms(x)
        return self.along @ (lengths * cos) + self.up @ (lengths * sin) + self.linear @ x + self.constant

    def raw_jacobian(self, x):
        stretched, lengths, cos, sin = self.terms(x)
        weights = np.concatenate((stretched * cos, stretched * sin, cos, sin, -lengths * sin, lengths * cos))
        return sp.csr_matrix((self.from_terms @ weights + self.fixed, self.indices, self.indptr), shape=self.shape)

    def folded(self, r):
        folded = np.sign(r) * self.cauchy * np.sqrt(np.log1p((r / self.cauchy) ** 2))
        return np.where(self.robust, folded, r)

    def residuals(self, x):
        return self.folded(self.raw(x))

    def jacobian(self, x):
        r = self.raw(x)
        folded, slope = self.folded(r), r / (1.0 + (r / self.cauchy) ** 2)
        small = np.abs(r) < 1e-6 * self.cauchy
        slopes = np.where(self.robust & ~small, slope / np.where(small, 1.0, folded), 1.0)
        jacobian = self.raw_jacobian(x)
        jacobian.data *= slopes[self.row_of]
        return jacobian


def check_jacobian(problem):
    """Every column against central differences, at a point away from the start."""
    x = problem.start + 0.05 * np.sin(np.arange(problem.shape[1]))
    jacobian, step = problem.jacobian(x).toarray(), 1e-6
    scale = np.abs(jacobian).max(axis=1)
    for column in range(problem.shape[1]):
        moved = np.zeros_like(x)
        moved[column] = step
        numeric = (problem.residuals(x + moved) - problem.residuals(x - moved)) / (2 * step)
        worst = np.max(np.abs(numeric - jacobian[:, column]) / scale)
        assert worst < 1e-6, f"column {column} of the Jacobian is off by {worst}"


def solve(problem, case, tr_solver, x_scale, tr_options):
    """One run; the clock covers the solver and its calls of residuals and Jacobian, not the cost that is watched."""
    best, evaluations, watching = np.inf, 0, 0.0
    begin = time.perf_counter()

    def watched(x):
        nonlocal best, evaluations, watching
        r = problem.residuals(x)
        at = time.perf_counter()
        best, evaluations = min(best, 0.5 * np.sum(r**2)), evaluations + 1
        watching += time.perf_counter() - at
        if best <= problem.optimum_cost * (1.0 + NEAR):
            raise Reached
        return r

    jacobian = problem.jacobian if tr_solver == "lsmr" else lambda x: problem.jacobian(x).toarray()
    start = np.clip(problem.start, *problem.bounds)
    try:
        result = least_squares(
            watched, start, jacobian, problem.bounds, method="trf", tr_solver=tr_solver, x_scale=x_scale,
            tr_options=tr_options, ftol=1e-12, xtol=1e-12, gtol=1e-12, max_nfev=MAX_EVALUATIONS,
        )
        note = f"{evaluations} evaluations; " + ("stopped elsewhere" if result.status > 0 else "did not converge")
    except Reached:
        note = f"{evaluations} evaluations"
    seconds = time.perf_counter() - begin - watching
    distance = best / problem.optimum_cost - 1.0
    line = {"case": case, "seconds": seconds, "cost": best, "relative_distance": distance, "note": note}
    print(json.dumps(line), flush=True)


# Name, trust-region solver, x_scale, its options.  "tuned" is the fastest of some forty settings tried on the very
# problem of the benchmark (limit of inner iterations, damping, scaling); scipy's own `loss` argument with a function for
# the robust residuals never converged, so the loss is folded into the residuals.
CASES = {
    "free": [
        ("trf lsmr sparse", "lsmr", "jac", {}),
        ("trf lsmr sparse, tuned", "lsmr", "jac", {"maxiter": 60}),
        ("trf exact dense", "exact", "jac", {}),
    ],
    "bounded": [
        ("trf lsmr sparse", "lsmr", "jac", {}),
        ("trf lsmr sparse, tuned", "lsmr", 1.0, {"maxiter": 80, "regularize": False}),
        ("trf exact dense", "exact", "jac", {}),
    ],
}


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        problem = StrideProblem(file)
    check_jacobian(problem)
    for settings in CASES["bounded" if problem.is_bounded else "free"]:
        solve(problem, *settings)


main()
