"""The VCI model once more: scalar, slow, with libm, and written from the equations alone."""

from __future__ import annotations

import math

import numpy as np


def flm(d, d_0, M, s):
    return M / (2 * d_0) * ((d_0 - d) + math.sqrt((d_0 - d) ** 2 + s**2))


def sinusoidal(cosine, l_):
    return l_ + (1 - l_) * (1 + max(-1.0, min(1.0, cosine))) / 2


def pair(p, x_i, v_i, x_j, v_j):
    """f_r, f_c, f_n on i from j."""
    zero = np.zeros(2)
    distance = math.dist(x_i, x_j)
    if distance > p.interaction_radius:
        return zero, zero, zero
    n = (x_j - x_i) / distance
    t = np.array([n[1], -n[0]])
    d = distance - 2 * p.body_radius
    speed = math.hypot(*v_i)
    cosine = n @ v_i / speed if speed > 0 else 0.0
    f_r = (
        -flm(d, p.repulsion_distance, p.repulsion_strength, p.repulsion_smoothing)
        * sinusoidal(cosine, p.repulsion_anisotropy)
        * n
    )
    f_c = -p.collision_stiffness * max(0.0, -d) * n
    w = v_i - v_j
    if math.hypot(*w) < 1e-3:
        return f_r, f_c, zero
    phi = math.atan2(abs(w[0] * n[1] - w[1] * n[0]), w @ n)
    sign = 1.0 if w @ t >= 0 else -1.0
    f_n = (
        flm(d, p.navigation_distance, p.navigation_strength, p.navigation_smoothing)
        * math.exp(-p.navigation_anisotropy * phi)
        * sign
        * t
    )
    return f_r, f_c, f_n


def nearest_on_segment(point, a, b):
    ab = b - a
    share = min(1.0, max(0.0, (point - a) @ ab / (ab @ ab)))
    return a + share * ab


def contour(p, vehicle, x):
    """Signed distance and outward unit vector (world frame) of the influence point."""
    x_v, y_v, psi, u, front, rear, width = vehicle
    forward = np.array([math.cos(psi), math.sin(psi)])
    left = np.array([-forward[1], forward[0]])
    if u < 0:
        forward, front, rear = -forward, rear, front
    moving = abs(u) >= p.static_speed
    h = width / 2 + p.vehicle_clearance
    X_r = -(rear + p.vehicle_clearance)
    X_s = front + p.vehicle_clearance + (p.vehicle_nose if moving else 0.0)
    tip = X_s + (p.vehicle_lookahead * abs(u) if moving else 0.0)
    away = np.asarray(x) - (x_v, y_v)
    side = 1.0 if away @ left >= 0 else -1.0
    at = np.array([away @ forward, abs(away @ left)])
    if at[0] < X_r:
        q, inside, edge = np.array([X_r, min(at[1], h)]), False, np.array([-1.0, 0.0])
    elif at[0] < X_s:
        q, inside, edge = np.array([at[0], h]), at[1] < h, np.array([0.0, 1.0])
    else:
        q = nearest_on_segment(at, np.array([X_s, h]), np.array([tip, 0.0]))
        edge = np.array([h, tip - X_s]) / math.hypot(h, tip - X_s)
        inside = (at - (X_s, h)) @ edge < 0
    distance = math.dist(at, q)
    if distance > 1e-9:
        edge = (q - at if inside else at - q) / distance
    return (-distance if inside else distance), edge[0] * forward + side * edge[1] * left


def vehicle(p, one, x, v):
    """f_v of one vehicle, and the signed distance."""
    x_v, y_v, psi, u, *_ = one
    s, e = contour(p, one, x)
    to = np.array([x_v, y_v]) - x
    w = v - u * np.array([math.cos(psi), math.sin(psi)])
    lengths = math.hypot(*to) * math.hypot(*w)
    cosine = to @ w / lengths if lengths > 0 else 1.0
    anisotropy = 1.0 if s < p.body_radius else sinusoidal(cosine, p.vehicle_anisotropy)
    exponent = min(-p.vehicle_decay * (s - p.body_radius), p.vehicle_exponent_cap)
    return p.vehicle_strength * math.exp(exponent) * anisotropy * e, s


def forces(p, x, v, v_0, targets, vehicles):
    """Sums for everyone: repulsion, collision, navigation, vehicle, destination, beta."""
    n = len(x)
    f_r, f_c, f_n, f_v, f_d = (np.zeros((n, 2)) for _ in range(5))
    beta = np.zeros(n)
    for i in range(n):
        for j in range(n):
            if i != j:
                r, c, navigation = pair(p, x[i], v[i], x[j], v[j])
                f_r[i] += r
                f_c[i] += c
                f_n[i] += navigation
        for one in vehicles:
            f_v[i] += vehicle(p, one, x[i], v[i])[0]
        to = targets[i] - x[i]
        v_d = v_0[i] * to / math.sqrt(to @ to + p.destination_smoothing**2)
        f_d[i] = p.destination_gain * (v_d - v[i])
        size = math.hypot(*f_v[i])
        beta[i] = (p.influence_high - size) / (p.influence_high - p.influence_low)
    return f_r, f_c, f_n, f_v, f_d, np.clip(beta, 0.0, 1.0)


def step(p, x, v, v_0, targets, vehicles, dt):
    """Positions and velocities after one step."""
    f_r, f_c, f_n, f_v, f_d, beta = forces(p, x, v, v_0, targets, vehicles)
    F = f_r + f_c + f_n + f_v + beta[:, None] * f_d
    for i in range(len(x)):
        size = math.hypot(*F[i])
        F[i] *= min(1.0, p.mass * p.max_acceleration / size) if size > 0 else 1.0
        end = v[i] + dt * F[i] / p.mass
        speed = math.hypot(*end)
        if speed > p.max_speed:
            F[i] = p.mass / dt * (p.max_speed * end / speed - v[i])
    return x + v * dt + F / (2 * p.mass) * dt**2, v + F / p.mass * dt
