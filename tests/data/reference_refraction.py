"""Writes reference_refraction.csv: rays traced through the exponential atmosphere of ITU-R P.453.

Run: python3 reference_refraction.py > reference_refraction.csv (no packages; about a minute)

The path is that of the eikonal equation, d/ds (n dr/ds) = grad n, in plane Cartesian coordinates
round the centre of a sphere of 6370 km, by the classical Runge-Kutta method of fourth order from
the site to 1,000 km. No formula of bending, of layers or of Bouguer's invariant is used.

Columns: altitude of the site; refractivity at sea level; apparent elevation, which is that of the
ray at the site; elevation of the ray beyond the air, as from the site (a satellite far away); and
elevation of the line from the site to the point in which the ray reaches 400 km.
"""

import math

EARTH_KM = 6370.0
HEIGHT_KM = 7.35


def slope(x, y, u, v, sea_level_n):
    """Derivatives by path length of the place and of n times the direction."""
    radius = math.hypot(x, y)
    excess = 1e-6 * sea_level_n * math.exp(-(radius - EARTH_KM) / HEIGHT_KM)
    n = 1.0 + excess
    gradient = -excess / HEIGHT_KM / radius
    return u / n, v / n, gradient * x, gradient * y


def trace(altitude_km, sea_level_n, apparent_deg):
    x, y = 0.0, EARTH_KM + altitude_km
    excess = 1e-6 * sea_level_n * math.exp(-altitude_km / HEIGHT_KM)
    apparent = math.radians(apparent_deg)
    u, v = (1.0 + excess) * math.cos(apparent), (1.0 + excess) * math.sin(apparent)
    at_400 = None
    while True:
        height = math.hypot(x, y) - EARTH_KM
        if height > 1000.0:
            return math.degrees(math.atan2(v, u)), at_400
        step = 0.2 if height < 120.0 else 2.0
        before = (x, y, height)
        state = (x, y, u, v)
        k1 = slope(*state, sea_level_n)
        k2 = slope(*(a + 0.5 * step * b for a, b in zip(state, k1)), sea_level_n)
        k3 = slope(*(a + 0.5 * step * b for a, b in zip(state, k2)), sea_level_n)
        k4 = slope(*(a + step * b for a, b in zip(state, k3)), sea_level_n)
        x, y, u, v = (
            a + step / 6.0 * (b + 2.0 * c + 2.0 * d + e)
            for a, b, c, d, e in zip(state, k1, k2, k3, k4)
        )
        after = math.hypot(x, y) - EARTH_KM
        if at_400 is None and after >= 400.0:
            part = (400.0 - before[2]) / (after - before[2])
            px, py = before[0] + part * (x - before[0]), before[1] + part * (y - before[1])
            at_400 = math.degrees(math.atan2(py - EARTH_KM - altitude_km, px))


ELEVATIONS = [0, 0.1, 0.25, 0.5, 0.75, 1, 1.5, 2, 3, 4, 5, 7, 10, 15, 20, 30, 45, 60, 75, 89, 90]
print("altitude_m,sea_level_n,apparent_deg,geometric_deg,geometric_at_400_km_deg")
for altitude_km in (-0.4, 0.0, 1.0, 3.0, 5.0):
    for apparent_deg in ELEVATIONS:
        far, near = trace(altitude_km, 315.0, apparent_deg)
        print(f"{1000 * altitude_km:.0f},315,{apparent_deg},{far:.7f},{near:.7f}")
for sea_level_n in (200.0, 260.0, 400.0):
    for apparent_deg in ELEVATIONS:
        far, near = trace(0.0, sea_level_n, apparent_deg)
        print(f"0,{sea_level_n:.0f},{apparent_deg},{far:.7f},{near:.7f}")
