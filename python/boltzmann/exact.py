"""Exact solutions, for comparison with simulations: gases, plasmas, orbits and vortices.

Places and times may be numbers or arrays of any shape; results have their common broadcast shape. Use any
consistent units. Wrong input raises boltzmann.Error.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ._core import exact_ as _exact
from .errors import Error

class Gas(NamedTuple):
    density: Any
    velocity: Any
    pressure: Any

class Star(NamedTuple):
    pressure: Any
    velocity: Any
    left_density: Any
    right_density: Any
    shock_speed: Any

class Front(NamedTuple):
    radius: Any
    speed: Any

class Wave(NamedTuple):
    frequency: Any
    growth: Any

class State(NamedTuple):
    position: Any
    velocity: Any

class Elements(NamedTuple):
    semi_major_axis: Any
    eccentricity: Any
    inclination: Any
    node: Any
    pericentre: Any
    mean_anomaly: Any

class Vortex(NamedTuple):
    velocity: Any
    vorticity: Any

class Flow(NamedTuple):
    velocity: Any
    vorticity: Any
    pressure: Any



def _numbers(name: str, value: Any) -> npt.NDArray[np.float64]:
    try:
        return np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise Error(f"exact solutions: {name} must be numbers, not {value!r:.60}") from None


def _number(name: str, value: Any) -> float:
    number = _numbers(name, value)
    if number.ndim != 0:
        raise Error(f"exact solutions: {name} must be one number, not {number.size} in an array")
    return float(number)


def _together(**places: Any) -> tuple[list[npt.NDArray[np.float64]], tuple[int, ...]]:
    """Arrays of one shape, flat, and that shape."""
    arrays = [_numbers(name, value) for name, value in places.items()]
    try:
        arrays = np.broadcast_arrays(*arrays)
    except ValueError:
        shapes = " and ".join(f"{name} {array.shape}" for name, array in zip(places, arrays))
        raise Error(f"exact solutions: the shapes of {shapes} don't fit together") from None
    return [array.ravel() for array in arrays], arrays[0].shape


def _columns(found: dict[str, bytes], shape: tuple[int, ...]) -> list[Any]:
    """Arrays of this shape; single numbers for the shape ()."""
    return [np.frombuffer(column, dtype=np.float64).reshape(shape)[()].copy() for column in found.values()]


def _in_space(name: str, value: Any) -> tuple[npt.NDArray[np.float64], int]:
    """Three components, and how many there were: 2 (in the plane z = 0) or 3."""
    vector = _numbers(name, value)
    if vector.shape not in ((2,), (3,)):
        raise Error(f"exact solutions: {name} must have 2 or 3 components, not the shape {vector.shape}")
    return np.append(vector, np.zeros(3 - vector.size)), vector.size


def riemann(x: npt.ArrayLike, t: npt.ArrayLike, left: npt.ArrayLike, right: npt.ArrayLike, gamma: float = 1.4) -> Gas:
    """Two gases that meet at x = 0 at t = 0: density, velocity and pressure at x and t.

    left and right are (density, velocity, pressure); gamma is the ratio of specific heats. Where a vacuum would open
    between the gases there is no solution (boltzmann.Error).
    """
    (x, t), shape = _together(x=x, t=t)
    left, right = _numbers("left", left).ravel(), _numbers("right", right).ravel()
    return Gas(*_columns(_exact.riemann(x, t, left, right, _number("gamma", gamma)), shape))


def riemann_star(left: npt.ArrayLike, right: npt.ArrayLike, gamma: float = 1.4) -> Star:
    """Pressure and velocity at the contact of two gases that met, the densities on its left and right, and the velocity
    of the shock that runs to the right (NaN if a rarefaction does)."""
    left, right = _numbers("left", left).ravel(), _numbers("right", right).ravel()
    return Star(*_exact.riemann_star(left, right, _number("gamma", gamma)))


def sod(x: npt.ArrayLike, t: npt.ArrayLike, gamma: float = 1.4) -> Gas:
    """Sod's shock tube: density and pressure are 1 on the left, 1/8 and 1/10 on the right, at rest."""
    return riemann(x, t, (1, 0, 1), (0.125, 0, 0.1), gamma)


def sedov(
    r: npt.ArrayLike, t: npt.ArrayLike, energy: float = 1, density: float = 1, gamma: float = 1.4, dimension: int = 3
) -> Gas:
    """Sedov's blast from a point (a line in 2D, a plane in 1D) in cold gas: density, velocity outwards and pressure at
    the distance r. The energy is all of it, in 2D per length, in 1D per area on both sides of the plane."""
    (r, t), shape = _together(r=r, t=t)
    found = _exact.sedov(r, t, _number("energy", energy), _number("density", density), _number("gamma", gamma),
                         _dimension(dimension))
    return Gas(*_columns(found, shape))


def sedov_front(
    t: npt.ArrayLike, energy: float = 1, density: float = 1, gamma: float = 1.4, dimension: int = 3
) -> Front:
    """Radius and speed of the shock of Sedov's blast."""
    (t,), shape = _together(t=t)
    found = _exact.sedov_radius(t, _number("energy", energy), _number("density", density), _number("gamma", gamma),
                                _dimension(dimension))
    return Front(*_columns(found, shape))


def _dimension(dimension: Any) -> int:
    if not np.isscalar(dimension) or dimension not in (1, 2, 3):
        raise Error(f"Sedov's blast: the dimension must be 1, 2 or 3, it is {dimension!r:.60}")
    return (1, 2, 3).index(dimension) + 1


def langmuir(k: npt.ArrayLike, plasma_frequency: float = 1, thermal_velocity: float = 1) -> Wave:
    """Frequency and growth (negative: Landau's damping) of plasma waves with the wave number k, by kinetic theory.

    The thermal velocity is sqrt(kT/m). With the default values k is that times the Debye length.
    """
    (k,), shape = _together(k=k)
    found = _exact.langmuir(k, _number("plasma_frequency", plasma_frequency),
                            _number("thermal_velocity", thermal_velocity))
    return Wave(*_columns(found, shape))


def bohm_gross(k: npt.ArrayLike, plasma_frequency: float = 1, thermal_velocity: float = 1) -> Any:
    """The frequency of long plasma waves, sqrt(wp^2 + 3 k^2 v^2)."""
    (k,), shape = _together(k=k)
    found = _exact.bohm_gross(k, _number("plasma_frequency", plasma_frequency),
                              _number("thermal_velocity", thermal_velocity))
    return _columns(found, shape)[0]


def two_streams(k: npt.ArrayLike, drift: float = 1, thermal_velocity: float = 0, plasma_frequency: float = 1) -> Any:
    """The growth rate of waves in two equal streams of electrons with the velocities +drift and -drift, which have half
    of the square of the plasma frequency each; 0 where they are stable."""
    (k,), shape = _together(k=k)
    found = _exact.two_streams(k, _number("plasma_frequency", plasma_frequency), _number("drift", drift),
                               _number("thermal_velocity", thermal_velocity))
    return _columns(found, shape)[0]


def plasma_frequency(number_density: float, charge: float, mass: float, coulomb_constant: float = 1) -> float:
    """sqrt(4 pi C n q^2 / m), with C = 1 in Gaussian units and 8.98755e9 in SI."""
    found = _exact.plasma_frequency(_number("number_density", number_density), _number("charge", charge),
                                    _number("mass", mass), _number("coulomb_constant", coulomb_constant))
    return float(found)


def kepler(t: npt.ArrayLike, position: npt.ArrayLike, velocity: npt.ArrayLike, mu: float = 1) -> State:
    """Where a body is at the times t that is at `position` with `velocity` at t = 0, about a centre that attracts it by
    mu / r^2 (mu = G (M + m)). Arrays have the components (2 or 3, as they came) along their last axis."""
    (t,), shape = _together(t=t)
    (start, size), (speed, other) = _in_space("position", position), _in_space("velocity", velocity)
    if size != other:
        raise Error(f"exact solutions: position has {size} components, velocity {other}")
    found = _columns(_exact.kepler(t, start, speed, _number("mu", mu)), (*shape, 3))
    return State(*(column[..., :size] for column in found))


def orbit_elements(position: npt.ArrayLike, velocity: npt.ArrayLike, mu: float = 1) -> Elements:
    """The elements of the orbit through a state; angles in radians."""
    (position, _), (velocity, _) = _in_space("position", position), _in_space("velocity", velocity)
    return Elements(*_exact.orbit_elements(position, velocity, _number("mu", mu)))


def orbit_state(
    semi_major_axis: float, eccentricity: float = 0, inclination: float = 0, node: float = 0, pericentre: float = 0,
    mean_anomaly: float = 0, mu: float = 1,
) -> State:  # fmt: skip
    """Position and velocity that have these elements; angles in radians. The axis of a hyperbola is negative."""
    elements = dict(semi_major_axis=semi_major_axis, eccentricity=eccentricity, inclination=inclination, node=node,
                    pericentre=pericentre, mean_anomaly=mean_anomaly, mu=mu)
    return State(*_columns(_exact.orbit_state(*(_number(name, value) for name, value in elements.items())), (3,)))


def orbit_period(semi_major_axis: float, mu: float = 1) -> float:
    """2 pi sqrt(a^3 / mu)."""
    return float(_exact.orbit_period(_number("semi_major_axis", semi_major_axis), _number("mu", mu)))


def lamb_oseen(r: npt.ArrayLike, t: npt.ArrayLike, circulation: float = 1, viscosity: float = 1) -> Vortex:
    """The velocity around the vortex of Lamb and Oseen and its vorticity, at the distance r and the time t since it was
    a line."""
    (r, t), shape = _together(r=r, t=t)
    found = _exact.lamb_oseen(r, t, _number("circulation", circulation), _number("viscosity", viscosity))
    return Vortex(*_columns(found, shape))


def taylor_green(
    x: npt.ArrayLike, y: npt.ArrayLike, t: npt.ArrayLike, speed: float = 1, edge: float = 1, viscosity: float = 1,
    density: float = 1,
) -> Flow:  # fmt: skip
    """Velocity (its components along the last axis), vorticity and pressure of the vortices of Taylor and Green in a
    periodic square, at one time t."""
    (x, y), shape = _together(x=x, y=y)
    found = _exact.taylor_green(x, y, _number("t", t), _number("speed", speed), _number("edge", edge),
                                _number("viscosity", viscosity), _number("density", density))
    along_x, along_y, vorticity, pressure = _columns(found, shape)
    return Flow(np.stack((along_x, along_y), axis=-1), vorticity, pressure)
