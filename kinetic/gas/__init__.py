r"""The chain as a gas along labels: its steady state, its fluctuations, its motion.

A label l counts rods from the left, 0 to L. In the reduced coordinate y = x - 2R (N - L/2) the rods
are points. With the place y(l, t) of a label, the flow V, the variance T of the velocities about V
(the temperature over the mass) and their third moment q = <(v - V)^3>,

    y_t = V,                              n = 1/y_l   (rods per length),      P = phi T n,
    V_t = -P_l - F(y - y0) - Gamma V,
    T_t = -2 T n V_l - (n q)_l + 2 Gamma (1 - h - T) - Lambda,
    q_t = -3 n T T_l - 3 n q V_l - r q.

**Units.** Velocities are in units of W, that of a free rod, and lengths in a unit u: the thermal
length s, or in a box the room of a rod (X - 2RL)/L where that is shorter. Times are in u/W, and
Gamma is gamma u/(m W). y0(l) is the anchor, and F the force of a spring over the mass.

**Closures.** The fourth moment is that of a Gaussian, 3 T^2. Collisions take Lambda from the sum of
v^2 of two neighbours per time, and the third moment decays at the rate r,

    Lambda = a zeta(e) n T^(3/2),      r = 3 Gamma + a c(e) n sqrt(T),

where zeta and c are ``energy`` and ``decay`` of :mod:`.collision_moments`. In time r has one more
term, n sqrt(T) |T_l|/T, which bounds q where the temperature changes within the free flight of a
rod. phi = P/(n T) is 1 for points, and less with a gap (:mod:`.descriptions`).

In the mean field, where colliding rods are independent, a = 1 and h = 0. The fluctuations of
the same equations give a(l) and h(l), the part of <v^2> that whole neighbourhoods share
(:mod:`.closure`, :mod:`.fluctuations`).

**Ends.** Beyond an open end there is no rod: P = 0, q = 0. A wall is a contact at which P acts on
the flow and where y is given, with a loss (:mod:`.mean_state`).

**What it contains.** At e = 1 the steady state is T = 1, q = 0 and P_l = -F, the force balance of
the paper. In time (:mod:`crazybilliards.kinetic.fluids`) without q it is the paper's fluid.
"""
