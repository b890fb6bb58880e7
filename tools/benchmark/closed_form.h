/*
 * The closed form that every peer is given that needs a right-hand side, M(q)^-1 (tau - C v) with all constants worked
 * out beforehand. Included once for each type of number (scenes.h: double), with
 *   FORM_REAL         the type
 *   FORM_SIN, _COS, _SQRT
 *   FORM(name)        what the functions are called
 * No include guard: that is the point. tests/benchmark holds it against mct_system.evaluate.
 *
 * NAME_constants  from the parameters of the scene, in their order in scenes.c
 * NAME_rate       time derivative of the state x under the input u
 */

/* x = (th, w) */
static inline void FORM(pendulum_constants)(const double *p, FORM_REAL *k)
{
    const FORM_REAL m = p[0], l = p[1], g = p[2];
    k[0] = g / l;
    k[1] = 1 / (m * l * l);
}

static inline void FORM(pendulum_rate)(const FORM_REAL *k, FORM_REAL u, const FORM_REAL *x, FORM_REAL *dx)
{
    dx[0] = x[1];
    dx[1] = k[0] * FORM_SIN(x[0]) + k[1] * u;
}

/* x = (X, Y, Xd, Yd), Cartesian: neither sine nor cosine, and no singularity. u is a torque about the pivot. */
static inline void FORM(spring_constants)(const double *p, FORM_REAL *k)
{
    const FORM_REAL m = p[0], stiffness = p[1], rest = p[2], g = p[3];
    k[0] = stiffness / m;
    k[1] = stiffness * rest / m;
    k[2] = g;
    k[3] = 1 / m;
}

static inline void FORM(spring_rate)(const FORM_REAL *k, FORM_REAL u, const FORM_REAL *x, FORM_REAL *dx)
{
    const FORM_REAL square = x[0] * x[0] + x[1] * x[1];
    const FORM_REAL pull = k[1] / FORM_SQRT(square) - k[0];
    const FORM_REAL turning = k[3] * u / square;
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = pull * x[0] - turning * x[1];
    dx[3] = pull * x[1] + turning * x[0] - k[2];
}

/* x = (p, th, pd, thd) */
static inline void FORM(cart_pole_constants)(const double *p, FORM_REAL *k)
{
    const FORM_REAL m1 = p[0], m2 = p[1], l = p[2], g = p[5];
    k[0] = m1;
    k[1] = m2;
    k[2] = m2 * l;
    k[3] = m2 * g * l;
    k[4] = 1 / l;
    k[5] = (m1 + m2) / (m2 * l * l);
    k[6] = p[3];
    k[7] = p[4];
}

static inline void FORM(cart_pole_rate)(const FORM_REAL *k, FORM_REAL u, const FORM_REAL *x, FORM_REAL *dx)
{
    const FORM_REAL s = FORM_SIN(x[1]), c = FORM_COS(x[1]);
    const FORM_REAL f1 = u + k[2] * s * x[3] * x[3] - k[6] * x[2];
    const FORM_REAL f2 = k[3] * s - k[7] * x[3];
    const FORM_REAL inverse = 1 / (k[0] + k[1] * s * s);
    const FORM_REAL c_over_l = c * k[4];
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = inverse * (f1 - c_over_l * f2);
    dx[3] = inverse * (k[5] * f2 - c_over_l * f1);
}

/* x = (th1, th2, w1, w2, i); M is constant. */
static inline void FORM(wheel_constants)(const double *p, FORM_REAL *k)
{
    const FORM_REAL mass = p[0], wheel = p[1], l = p[2], arm = p[3], moment = p[4], g = p[5];
    k[0] = 1 / (mass * l * l + arm); /* 1 / J */
    k[1] = 1 / wheel;
    k[2] = (moment + mass * l) * g;
    k[3] = p[6]; /* friction of the arm, of the wheel */
    k[4] = p[7];
    k[5] = p[8]; /* k_T, k_b / L, R / L, 1 / L */
    k[6] = (FORM_REAL)p[9] / p[11];
    k[7] = (FORM_REAL)p[10] / p[11];
    k[8] = 1 / (FORM_REAL)p[11];
}

static inline void FORM(wheel_rate)(const FORM_REAL *k, FORM_REAL u, const FORM_REAL *x, FORM_REAL *dx)
{
    const FORM_REAL torque = k[5] * x[4] - k[4] * x[3];
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = k[0] * (k[2] * FORM_SIN(x[0]) - k[3] * x[2] - torque);
    dx[3] = k[1] * torque - dx[2];
    dx[4] = k[8] * u - k[6] * x[3] - k[7] * x[4];
}

/* Of the wheel's rates by its state, row-major: for implicit methods. */
static inline void FORM(wheel_jacobian)(const FORM_REAL *k, const FORM_REAL *x, FORM_REAL *J)
{
    const FORM_REAL pull = k[0] * k[2] * FORM_COS(x[0]);
    const FORM_REAL rows[5][5] = {
        {0, 0, 1, 0, 0},
        {0, 0, 0, 1, 0},
        {pull, 0, -k[0] * k[3], k[0] * k[4], -k[0] * k[5]},
        {-pull, 0, k[0] * k[3], -(k[0] + k[1]) * k[4], (k[0] + k[1]) * k[5]},
        {0, 0, 0, -k[6], -k[7]},
    };
    for (int i = 0; i < 25; i++) {
        J[i] = rows[i / 5][i % 5];
    }
}

/* x = (quaternion, angular velocity in body axes); principal axes. */
static inline void FORM(body_constants)(const double *p, FORM_REAL *k)
{
    for (int i = 0; i < 3; i++) {
        k[i] = ((FORM_REAL)p[(i + 1) % 3] - p[(i + 2) % 3]) / p[i];
    }
}

static inline void FORM(body_rate)(const FORM_REAL *k, FORM_REAL u, const FORM_REAL *x, FORM_REAL *dx)
{
    const FORM_REAL a = x[4] / 2, b = x[5] / 2, c = x[6] / 2;
    (void)u;
    dx[0] = -x[1] * a - x[2] * b - x[3] * c;
    dx[1] = x[0] * a + x[2] * c - x[3] * b;
    dx[2] = x[0] * b + x[3] * a - x[1] * c;
    dx[3] = x[0] * c + x[1] * b - x[2] * a;
    dx[4] = k[0] * x[5] * x[6];
    dx[5] = k[1] * x[6] * x[4];
    dx[6] = k[2] * x[4] * x[5];
}
