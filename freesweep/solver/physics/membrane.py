"""The source's tube at one point: a membrane with bonded fibers. Its Lagrangian density and the partial derivatives.

Everything is dimensionless: lengths by the undeformed radius r0, pressure by C10, force by pi r0^2 C10, torque by
pi r0^3 C10, energy by pi r0^3 C10. The unknown is the circumferential stretch ``y`` with slope ``v = dy/dxi``.

Fiber constraints (Eqs. 2.3, 2.4), solved for twist rate and meridional stretch, with H = (tan(alpha) + tan(beta))/2 and
D = (tan(alpha) - tan(beta))/2::

    psi(y) = H (gamma^2/y^2 - 1)
    G(y)   = lambda_1^2 = gamma^2 (1 + H^2 + D^2) - D^2 y^2 - gamma^4 H^2/y^2
    s(y,v) = sqrt(G - v^2)                                     axial length per undeformed length

Functional (Eqs. 2.2, 2.5 - 2.8, 2.11; tension positive, unlike Eq. 2.11 where F is positive in compression)::

    L(y, v) = (p y^2 + f) s - e a w(y) + m psi(y)
    w       = (I1 - 3) + c (I2 - 3),  c = C01/C10              (Eq. 2.5)
              + c2 (I1 - 3)^2 + c3 (I1 - 3)^3                  Yeoh, c2 = C2/C1, c3 = C3/C1, C10 = C1
    I1      = G + y^2 (1 + k psi^2) + 1/(G y^2)
    I2      = G y^2 + 1/y^2 + (1 + k psi^2)/G

``k`` (``shear``) is 1 for the invariants of the whole in-plane tensor, whose twist shears the wall, and 0 for
Eq. 2.5 as printed, which takes lambda_1 and lambda_2 for principal stretches.

``cell`` holds what may vary along the tube, (H, D, a); ``load`` what does not, (gamma, rubber, wall, p, f, m, e), with
``rubber`` = (c, c2, c3), or (c,): then no code is made for Yeoh's part, and ``wall`` = (k,). The weight ``e`` of the
strain energy is 1; 0 gives the locked shape (section 2.2). All functions are plain arithmetic: they run on a float or
on any number-like lane type.
"""

from math import sqrt

from ...jit import kernel

DRAWN_IN = 0.05  # share of radius or length
NO_ROOM = 1e-30  # stands for G - v^2 where that is negative: the state is refused, its numbers stay finite
LAST_STEP = 10.0  # share of Newton's tolerance in every error bound
ROUNDING = 2e-13  # relative floor of every error bound
ENERGY_ROUNDING = 4e-15  # the energy's, times the work of the loads
WORK_STEP = 4.0  # share of Newton's tolerance in that: the volume changes twice as much as y, and the length with it


@kernel
def kinematics(y, cell, load):
    """``(psi, psi_y, psi_yy, G - 1, G_y, G_yy)``: twist rate and squared meridional stretch (Eqs. 2.3, 2.4).

    G - 1 and not G: near the undeformed state the strain energy lives in its last digits.
    """
    H, D = cell[0], cell[1]
    gg = load.gamma * load.gamma
    r = 1.0 / y
    t = gg * r * r
    psi = H * (t - 1.0)
    psi_y = -2.0 * H * t * r
    psi_yy = 6.0 * H * t * r * r
    b = gg * H * H * t
    stretch = (load.gamma - 1.0) * (load.gamma + 1.0)
    G_1 = stretch + ((y - 1.0) * (y + 1.0) - stretch) * (H * H * t - D * D)
    G_y = -2.0 * D * D * y + 2.0 * b * r
    G_yy = -2.0 * D * D - 6.0 * b * r * r
    return psi, psi_y, psi_yy, G_1, G_y, G_yy


@kernel
def excess(a, b, inverse):
    """``A + B + 1/(A B) - 3`` for ``A = 1 + a``, ``B = 1 + b``, without cancellation near a = b = 0, from 1/(A B)."""
    return ((a + b) * (a + b + a * b) - a * b) * inverse


@kernel
def yeoh_slope(rubber, i):
    """dw/dI1 of I1 - 3 = ``i``, without Mooney-Rivlin's second part."""
    return 1.0 if len(rubber) == 1 else 1.0 + i * (2.0 * rubber[1] + 3.0 * rubber[2] * i)


@kernel
def yeoh(rubber, i, i_y, i_yy):
    """What I1 alone adds to ``(w, w_y, w_yy)``: ``i`` = I1 - 3, and more where Yeoh's higher constants are not 0."""
    if len(rubber) == 1:
        return i, i_y, i_yy
    c2, c3 = rubber[1], rubber[2]
    if max(abs(c2), abs(c3)) > 0.0:  # the others need not pay for it
        slope = yeoh_slope(rubber, i)
        return i * (1.0 + i * (c2 + c3 * i)), slope * i_y, slope * i_yy + (2.0 * c2 + 6.0 * c3 * i) * i_y * i_y
    return i, i_y, i_yy


@kernel
def strain_energy(y, cell, load):
    """``(w, w_y, w_yy)``: strain energy density over C10, its first and second derivative along y (Eq. 2.5)."""
    psi, psi_y, psi_yy, G_1, G_y, G_yy = kinematics(y, cell, load)
    rubber, k = load.rubber, load.wall[0]
    c = rubber[0]
    G = 1.0 + G_1
    r = 1.0 / y
    z = r * r  # 1/y^2
    e = 1.0 / G
    e_y = -G_y * e * e
    e_yy = (2.0 * G_y * G_y * e - G_yy) * e * e
    q = k * psi * psi  # shear that the twist makes
    q_y = 2.0 * k * psi * psi_y
    q_yy = 2.0 * k * (psi_y * psi_y + psi * psi_yy)
    y2 = y * y
    b = (y - 1.0) * (y + 1.0)
    first = excess(G_1, b, e * z) + y2 * q
    first_y = G_y + 2.0 * y * (1.0 + q) + y2 * q_y + e_y * z - 2.0 * e * z * r
    first_yy = G_yy + 2.0 * (1.0 + q) + 4.0 * y * q_y + y2 * q_yy + e_yy * z - 4.0 * e_y * z * r + 6.0 * e * z * z
    second = excess(-G_1 * e, -b * z, G * y2) + q * e
    second_y = G_y * y2 + 2.0 * G * y - 2.0 * z * r + q_y * e + (1.0 + q) * e_y
    second_yy = G_yy * y2 + 4.0 * G_y * y + 2.0 * G + 6.0 * z * z + q_yy * e + 2.0 * q_y * e_y + (1.0 + q) * e_yy
    w, w_y, w_yy = yeoh(rubber, first, first_y, first_yy)
    return w + c * second, w_y + c * second_y, w_yy + c * second_yy


@kernel
def density(y, v, cell, load):
    """Derivatives of the density L at one point (Eq. 2.11).

    Returns ``(room, L_y, L_v, L_yy, L_yv, L_vv)``. A state is admissible where ``room`` is positive: s is real, and the
    meridional resultant p y^2 + f is a tension.
    """
    p, f, m = load.p, load.f, load.m
    _, psi_y, psi_yy, G_1, G_y, G_yy = kinematics(y, cell, load)
    _, w_y, w_yy = strain_energy(y, cell, load)
    a = load.e * cell[2]
    G = 1.0 + G_1
    square = G - v * v
    s = sqrt(max(square, NO_ROOM))
    i = 1.0 / s
    i3 = i * i * i
    s_y = 0.5 * G_y * i
    s_v = -v * i
    s_yy = 0.5 * G_yy * i - 0.25 * G_y * G_y * i3
    s_yv = 0.5 * G_y * v * i3
    s_vv = -G * i3
    T = p * y * y + f
    T_y = 2.0 * p * y
    L_y = T_y * s + T * s_y - a * w_y + m * psi_y
    L_yy = 2.0 * p * s + 2.0 * T_y * s_y + T * s_yy - a * w_yy + m * psi_yy
    L_yv = T_y * s_v + T * s_yv
    return min(square, T), L_y, T * s_v, L_yy, L_yv, T * s_vv


@kernel
def handed_on(y, v, cell, load):
    """What a neighbour may start from, as of :mod:`.physical`."""
    psi, psi_y, _, G_1, G_y, _ = kinematics(y, cell, load)
    none = 0.0 * y
    return none, y, none + v, psi, psi_y, none, G_1, G_y, none


@kernel
def uniform_tube(y, cell, load):
    """``(sqrt(G), T sqrt(G), L)`` at slope 0: meridional stretch and resultant, and the density itself (Eq. 2.11)."""
    psi, _, _, G_1, _, _ = kinematics(y, cell, load)
    w, _, _ = strain_energy(y, cell, load)
    s = sqrt(max(1.0 + G_1, NO_ROOM))
    pull = (load.p * y * y + load.f) * s
    return s, pull, pull - load.e * cell[2] * w + load.m * psi


@kernel
def integrands(y, v, cell, load):
    """What the outputs integrate: axial length s, volume y^2 s, twist psi, strain energy a w (Eqs. 2.2, 2.5 - 2.7); and
    the kind of state, within which the density is smooth: there is one here.
    """
    psi, _, _, G_1, _, _ = kinematics(y, cell, load)
    w, _, _ = strain_energy(y, cell, load)
    s = sqrt(max(1.0 + G_1 - v * v, NO_ROOM))
    return s, y * y * s, psi, cell[2] * w, 0.0


@kernel
def locked_stretch(cell, gamma):
    """Stretch of the uniform locked tube: the largest y^2 sqrt(G) (Eq. 2.12)."""
    H, D = cell[0], cell[1]
    A = gamma * gamma * (1.0 + H * H + D * D)
    b = gamma * gamma * D * H
    return sqrt((A + sqrt(A * A - 3.0 * b * b)) / (3.0 * D * D))


@kernel
def longest(cell, gamma):
    """The largest meridional stretch that the fibers allow, whatever pulls: G at y^2 = gamma^2 |H/D| (Eqs. 2.3, 2.4)."""
    apart = abs(cell[0]) - abs(cell[1])
    return gamma * sqrt(1.0 + apart * apart)


@kernel
def drawn_in(cell, load):
    """The stretch below 1 from which a tube counts as drawn in: DRAWN_IN of its radius, and under force or torque as
    soon as its length has changed by that share.
    """
    size = abs(load.f) + abs(load.m)
    loaded = size / (size + NO_ROOM)  # 1, or 0
    _, _, _, G_1, G_y, _ = kinematics(1.0, cell, load)
    return 1.0 - DRAWN_IN * (1.0 + loaded * (min(2.0 * (1.0 + G_1) / max(abs(G_y), NO_ROOM), 1.0) - 1.0))


@kernel
def conjugate(y, v, cell, load, direction):
    """``(c, c_y, c_v, c_mu)`` with c = dL/dmu along a change of load: what is held when that load is unknown. L is
    linear in the loads here: c_mu = 0.
    """
    psi, psi_y, _, G_1, G_y, _ = kinematics(y, cell, load)
    s = sqrt(max(1.0 + G_1 - v * v, NO_ROOM))
    s_y = 0.5 * G_y / s
    s_v = -v / s
    T = direction.p * y * y + direction.f
    T_y = 2.0 * direction.p * y
    return T * s + direction.m * psi, T_y * s + T * s_y + direction.m * psi_y, T * s_v, 0.0


@kernel
def fiber_multipliers(y, s, cell, load):
    """:func:`multipliers` where the axial stretch ``s`` is known, not the slope: where the meridian stands upright,
    that has no digits to spare for it.
    """
    return multipliers(y, (load.p * y * y + load.f) / s, cell, load)


@kernel
def multipliers(y, pull, cell, load):
    """Multipliers of Eqs. 2.3 and 2.4 (alpha, beta family) under a ``pull``, the resultant over the axial stretch; a
    negative one belongs to a fiber that would have to push. The tension of a whole family is ``2 gamma tau/cos(angle)``
    in units of pi r0^2 C10.
    """
    H, D, a = cell[0], cell[1], load.e * cell[2]
    rubber, k, m = load.rubber, load.wall[0], load.m
    c = rubber[0]
    psi, _, _, G_1, _, _ = kinematics(y, cell, load)
    G = 1.0 + G_1
    q = 1.0 + k * psi * psi
    y2, e, r = y * y, 1.0 / G, 1.0 / y
    z = r * r
    slope = yeoh_slope(rubber, excess(G_1, (y - 1.0) * (y + 1.0), e * z) + y2 * k * psi * psi)
    w_G = slope * (1.0 - e * e * z) + c * (y2 - q * e * e)
    w_psi = 2.0 * k * psi * (slope * y2 + c * e)
    total = 0.5 * pull - a * w_G
    difference = (0.5 * (m - a * w_psi) - total * H * load.gamma * load.gamma) * z / D
    return 0.5 * (total + difference), 0.5 * (total - difference)


@kernel
def at_slope(y, v, cell, load):
    """``(G - v^2, tau alpha, tau beta)``: the room of the slope, and the multipliers of both families."""
    room = 1.0 + kinematics(y, cell, load)[3] - v * v
    alpha, beta = fiber_multipliers(y, sqrt(max(room, NO_ROOM)), cell, load)
    return room, alpha, beta


@kernel
def at_flux(y, flux, cell, load):
    """``(psi, G - 1, tau alpha, tau beta)`` where the flux T v/s is known and not the slope; see :mod:`..along.axial`."""
    psi, _, _, G_1, _, _ = kinematics(y, cell, load)
    meridional, pull, _ = uniform_tube(y, cell, load)
    T = pull / meridional
    alpha, beta = fiber_multipliers(y, pull / sqrt(T * T + flux * flux), cell, load)
    return psi, G_1, alpha, beta


@kernel
def scales(outputs, cell, load, length, tolerance):
    """By what each output's error is measured, and the error that rounding and Newton's last step (relative
    ``tolerance``) make: two tuples (length, volume, twist, energy, middle stretch, multiplier).

    Lengths count per undeformed length, stretch per radius, rotation per radian or relative to itself, the rest
    relative to itself. The energy of a hardly strained wall carries the rounding of y - 1, as work of the loads. Fibers
    far from the axis (large H and D in ``cell``) make much rotation and length of a little change of y.
    """
    share = ROUNDING + LAST_STEP * tolerance
    volume, turn, energy = outputs[1], outputs[2], outputs[3]
    work = abs(load.p * volume) + abs(load.f * outputs[0]) + abs(load.m * turn)
    gg, wrong = load.gamma * load.gamma, length * tolerance
    turned = 2.0 * abs(cell[0]) * gg * wrong  # psi_y at y = 1
    longer = abs(gg * gg * cell[0] * cell[0] - cell[1] * cell[1]) * wrong  # G_y/2 there
    larger = longer * volume / length
    by_turn = max(0.5, abs(turn))  # half a tube: half a radian
    by_energy = max(abs(energy), 1e-9 * work)  # that of a Yeoh wall which softens may be negative
    by_load = max(abs(load.p), max(abs(load.f), abs(load.m)))
    return (length, volume, by_turn, by_energy, 1.0, by_load), (
        share * length + longer,
        share * volume + larger,
        share * by_turn + turned,
        share * by_energy
        + (ENERGY_ROUNDING + WORK_STEP * tolerance) * work
        + (abs(load.p) * larger + abs(load.f) * longer + abs(load.m) * turned),
        share + ROUNDING * outputs[4],
        share * by_load,
    )
