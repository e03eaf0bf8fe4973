# SPDX-License-Identifier: GPL-3.0-or-later
"""Checked arrays, covariances, least squares and robust statistics do what they state."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core.arrays import finite, frozen, positive
from monocell.core.covariance import checked_covariance, inverse_information, propagated
from monocell.core.errors import InvalidValue
from monocell.core.least_squares import levenberg_marquardt
from monocell.core.robust import (
    beside_runs,
    correlation_inflation,
    robust_sigma,
    tukey_weights,
)

LAWS = settings(max_examples=30, deadline=None)
SEEDS = st.integers(0, 2**32 - 1)


def test_a_frozen_array_is_a_read_only_copy_of_floats():
    given_list = [[1, 2], [3, 4]]
    array = frozen(given_list, (None, 2), "points")
    given_list[0][0] = 9
    assert array.dtype == np.float64
    assert array[0, 0] == 1
    with pytest.raises(ValueError, match="read-only"):
        array[0, 0] = 5


@pytest.mark.parametrize(
    ("value", "shape", "told"),
    [
        ([1, 2], (3,), r"points: expected shape \(3\), got \(2,\)"),
        ([[1, 2]], (None, 3), r"expected shape \(N, 3\), got \(1, 2\)"),
        ([1, [2, 3]], (2,), "expected numbers"),
        (["a"], (1,), "expected numbers"),
        ([0, np.inf], (2,), r"number at \(1,\) is inf, not finite"),
        ({"x": 1}, (1,), "expected numbers"),
    ],
)
def test_what_does_not_fit_is_refused_with_its_name_and_numbers(value, shape, told):
    with pytest.raises(InvalidValue, match=told):
        frozen(value, shape, "points")


def test_single_numbers_are_checked_too():
    assert finite(3, "x") == 3.0
    assert positive(1e-9, "x") == 1e-9
    for value in (0, -2.0, np.nan, None, [1.0]):
        with pytest.raises(InvalidValue, match="radius"):
            positive(value, "radius")


def spread(seed, size=4):
    root = np.random.default_rng(seed).normal(size=(size, size + 1))
    return root @ root.T


@LAWS
@given(SEEDS)
def test_a_covariance_is_accepted_and_a_slightly_broken_one_is_not(seed):
    matrix = spread(seed)
    np.testing.assert_array_equal(checked_covariance(matrix, 4, "c"), matrix)
    scale = np.sqrt(np.diag(matrix))
    lopsided = matrix.copy()
    lopsided[0, 1] += 1e-3 * scale[0] * scale[1]
    with pytest.raises(InvalidValue, match="not symmetric"):
        checked_covariance(lopsided, 4, "c")
    impossible = matrix.copy()
    impossible[0, 1] = impossible[1, 0] = 1.5 * scale[0] * scale[1]
    with pytest.raises(InvalidValue, match="eigenvalue"):
        checked_covariance(impossible, 4, "c")


def test_a_covariance_of_something_known_exactly_is_one():
    checked_covariance(np.zeros((3, 3)), 3, "c")
    checked_covariance(np.diag([1e-12, 0.0, 4.0]), 3, "c")


@LAWS
@given(SEEDS)
def test_propagation_is_j_c_j_t_for_one_and_for_many(seed):
    covariance = spread(seed)
    jacobians = np.random.default_rng(seed).normal(size=(5, 2, 4))
    many = propagated(jacobians, covariance)
    for jacobian, one in zip(jacobians, many, strict=True):
        np.testing.assert_allclose(one, jacobian @ covariance @ jacobian.T)


@LAWS
@given(SEEDS)
def test_an_information_matrix_in_mixed_units_is_inverted(seed):
    units = np.array([1.0, 1e3, 1e-3, 1e5])
    information = spread(seed) * np.outer(units, units)
    inverse = inverse_information(information)
    np.testing.assert_allclose(
        inverse * np.outer(units, units) @ (information / np.outer(units, units)),
        np.eye(4),
        atol=1e-6,
    )


@pytest.mark.parametrize(
    "information",
    [np.zeros((3, 3)), np.diag([1.0, 0.0, 1.0]), np.ones((3, 3)), np.full((3, 3), np.nan)],
)
def test_information_that_leaves_a_direction_open_has_no_inverse(information):
    assert inverse_information(information) is None


def test_least_squares_finds_the_bottom_of_rosenbrock_s_valley():
    def evaluate(p):
        return (
            np.array([10 * (p[1] - p[0] ** 2), 1 - p[0]]),
            np.array([[-20 * p[0], 10.0], [-1.0, 0.0]]),
        )

    minimum = levenberg_marquardt(np.array([-1.2, 1.0]), evaluate, np.add)
    np.testing.assert_allclose(minimum.value, [1, 1], atol=1e-8)
    assert minimum.converged
    assert minimum.cost < 1e-16


@LAWS
@given(SEEDS)
def test_least_squares_of_a_line_is_numpy_s(seed):
    rng = np.random.default_rng(seed)
    rows, wanted = rng.normal(size=(9, 3)) * [1.0, 1e4, 1e-4], rng.normal(size=9)
    minimum = levenberg_marquardt(
        np.zeros(3), lambda p: (rows @ p - wanted, rows), np.add, tolerance=1e-14
    )
    best = np.linalg.lstsq(rows, wanted, rcond=None)[0]
    np.testing.assert_allclose(minimum.value * [1, 1e4, 1e-4], best * [1, 1e4, 1e-4], atol=1e-5)


def test_least_squares_turns_back_where_the_problem_has_no_value():
    def evaluate(p):
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.log(p) - np.log(0.01), np.diag(1 / p)

    minimum = levenberg_marquardt(np.array([3.0]), evaluate, np.add)
    np.testing.assert_allclose(minimum.value, [0.01], rtol=1e-6)


def test_least_squares_that_runs_out_of_steps_says_so():
    def evaluate(p):
        return np.array([p[0] ** 3]), np.array([[3 * p[0] ** 2]])

    assert not levenberg_marquardt(np.array([1.0]), evaluate, np.add, steps=2).converged


def test_least_squares_that_can_t_move_stays_where_it_is():
    minimum = levenberg_marquardt(
        np.array([2.0]), lambda p: (np.array([1.0]), np.array([[0.0]])), np.add
    )
    assert minimum.value.tolist() == [2.0]


@LAWS
@given(SEEDS)
def test_the_robust_sigma_is_that_of_the_core_whatever_a_fifth_does(seed):
    rng = np.random.default_rng(seed)
    residuals = rng.normal(0, 0.3, 1000)
    assert robust_sigma(residuals) == pytest.approx(0.3, rel=0.15)
    residuals[:200] = rng.choice([-50.0, 50.0], 200)
    assert 0.25 < robust_sigma(residuals) < 0.45


def test_tukey_s_weights_fall_from_one_to_nothing():
    weights = tukey_weights(np.array([0.0, 0.5, -0.5, 2.0, 4.685, -9.0]), 1.0)
    assert weights[0] == 1
    assert weights[1] == weights[2]
    assert 0 < weights[3] < weights[1] < 1
    assert weights[4] == weights[5] == 0


def test_independent_residuals_are_not_inflated_and_repeated_ones_are():
    rng = np.random.default_rng(1)
    values = rng.normal(size=400)
    used = np.ones(400, dtype=bool)
    assert correlation_inflation(values, used) < 1.4
    # each number four times over: the variance of their mean is four times as large
    assert 3 < correlation_inflation(np.repeat(values[:100], 4), used) < 5.5
    assert correlation_inflation(np.zeros(400), used) == 1.0


def test_what_lies_beside_a_run_of_outliers_goes_too_and_loners_harm_nobody():
    outliers = np.zeros(40, dtype=bool)
    outliers[[10, 11, 12, 30]] = True
    near = beside_runs(outliers)
    assert set(np.flatnonzero(near)) == set(range(7, 16))
    # the outline is closed
    around = beside_runs(np.roll(outliers, -11))
    assert set(np.flatnonzero(around)) == {36, 37, 38, 39, 0, 1, 2, 3, 4}
