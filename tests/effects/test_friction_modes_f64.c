/*
 * Exact dry friction on two coordinates against an independent integration: the textbook's equations by the classical
 * Runge-Kutta method in long double (19 digits), at 10 us, whose events are found by bisection and whose mode is the one
 * of all nine that agrees with itself.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/scenes.h"
#include "unity.h"

typedef long double real;

void setUp(void)
{
}

void tearDown(void)
{
}

typedef struct {
    int system;
    mct_scene scene;
    real u;
    real hold[2];
    real wheel_inertia;
    real p[11]; /* by the names below */
} model;

enum { VISCOUS, DRAG = 2, SLIDE = 4, GRAVITY = 6, MASS, LENGTH, INERTIA, MOMENT, NAMES };
static const char *const names[2][NAMES] = {
    {"cart_friction", "pole_friction", "cart_drag", "pole_drag", "cart_coulomb", "pole_coulomb", "gravity",
     "pole_mass", "pole_length", "cart_mass", "cart_mass"},
    {"arm_friction", "wheel_friction", "arm_drag", "wheel_drag", "arm_coulomb", "wheel_coulomb", "gravity",
     "wheel_mass", "arm_length", "arm_inertia", "arm_moment"}};

/* M (11, 12, 22) and all forces but dry friction, C v on their side. x: angles or way, then rates. */
static void textbook_forces(const model *self, const real *x, real *M, real *f)
{
    const uint32_t effects = self->scene.effects;
    for (int i = 0; i < 2; i++) {
        const real viscous = (effects & MCT_VISCOUS) ? self->p[VISCOUS + i] : 0;
        const real drag = (effects & MCT_DRAG) ? self->p[DRAG + i] : 0;
        f[i] = -viscous * x[2 + i] - drag * fabsl(x[2 + i]) * x[2 + i];
    }
    const real g = self->p[GRAVITY], m = self->p[MASS], l = self->p[LENGTH];
    if (self->system == CART_POLE) {
        M[0] = self->p[INERTIA] + m;
        M[1] = m * l * cosl(x[1]);
        M[2] = m * l * l;
        f[0] += self->u + m * l * x[3] * x[3] * sinl(x[1]);
        f[1] += m * g * l * sinl(x[1]);
    } else {
        M[1] = M[2] = self->wheel_inertia;
        M[0] = m * l * l + self->p[INERTIA] + M[2];
        f[0] += (self->p[MOMENT] + m * l) * g * sinl(x[0]);
        f[1] += self->u;
    }
}

/* Accelerations in a mode, and what is left of the equations of those at rest. */
static void solve(const model *self, const int *mode, const real *x, real *a, real *load)
{
    real M[3], f[2];
    textbook_forces(self, x, M, f);
    for (int i = 0; i < 2; i++) {
        f[i] -= mode[i] * self->p[SLIDE + i];
    }
    a[0] = a[1] = 0;
    if (mode[0] != 0 && mode[1] != 0) {
        const real det = M[0] * M[2] - M[1] * M[1];
        a[0] = (M[2] * f[0] - M[1] * f[1]) / det;
        a[1] = (M[0] * f[1] - M[1] * f[0]) / det;
    } else if (mode[0] != 0) {
        a[0] = f[0] / M[0];
    } else if (mode[1] != 0) {
        a[1] = f[1] / M[2];
    }
    load[0] = f[0] - M[0] * a[0] - M[1] * a[1];
    load[1] = f[1] - M[1] * a[0] - M[2] * a[1];
}

static void rate(const model *self, const int *mode, const real *x, real *dx)
{
    real load[2];
    dx[0] = x[2];
    dx[1] = x[3];
    solve(self, mode, x, dx + 2, load);
}

static void step(const model *self, const int *mode, const real *x, real h, real *end)
{
    real k[4][4], y[4];
    rate(self, mode, x, k[0]);
    for (int stage = 1; stage < 4; stage++) {
        for (int i = 0; i < 4; i++) {
            y[i] = x[i] + (stage == 3 ? h : h / 2) * k[stage - 1][i];
        }
        rate(self, mode, y, k[stage]);
    }
    for (int i = 0; i < 4; i++) {
        end[i] = x[i] + h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
    }
}

/* Which coordinate a mode has ended for at x; -1 while it lasts. */
static int ended(const model *self, const int *mode, const real *x)
{
    real a[2], load[2];
    solve(self, mode, x, a, load);
    for (int i = 0; i < 2; i++) {
        if (mode[i] == 0 ? fabsl(load[i]) > self->hold[i] : mode[i] * x[2 + i] < 0) {
            return i;
        }
    }
    return -1;
}

/* leaving: one that has just broken away that way, else 0 */
static void choose(const model *self, const real *x, const int *leaving, int *mode)
{
    for (int most = 2; most >= 0; most--) { /* at rest */
        for (int k = 0; k < 9; k++) {
            const int candidate[2] = {k % 3 - 1, k / 3 - 1};
            bool suits = (candidate[0] == 0) + (candidate[1] == 0) == most;
            real a[2], load[2];
            solve(self, candidate, x, a, load);
            for (int i = 0; i < 2; i++) {
                const int known = x[2 + i] > 0 ? 1 : x[2 + i] < 0 ? -1 : leaving[i];
                suits = suits && (known != 0          ? candidate[i] == known
                                  : candidate[i] == 0 ? fabsl(load[i]) <= self->hold[i]
                                                      : candidate[i] * a[i] > 0);
            }
            if (suits) {
                memcpy(mode, candidate, sizeof candidate);
                return;
            }
        }
    }
    TEST_FAIL_MESSAGE("no mode agrees");
}

static void advance(const model *self, real duration, real *x, int *visits, int *events)
{
    const real h = 1e-5L;
    const int none[2] = {0, 0};
    int mode[2];
    choose(self, x, none, mode);
    while (duration > 1e-18L) {
        const real whole = duration < h ? duration : h;
        real end[4];
        visits[(mode[0] + 1) + 3 * (mode[1] + 1)]++;
        step(self, mode, x, whole, end);
        if (ended(self, mode, end) < 0) {
            memcpy(x, end, sizeof end);
            duration -= whole;
            continue;
        }
        real low = 0, high = whole;
        for (int i = 0; i < 70; i++) {
            const real middle = (low + high) / 2;
            step(self, mode, x, middle, end);
            *(ended(self, mode, end) < 0 ? &low : &high) = middle;
        }
        step(self, mode, x, high, end);
        const int which = ended(self, mode, end);
        int leaving[2] = {0, 0};
        real a[2], load[2];
        solve(self, mode, end, a, load);
        if (mode[which] == 0) {
            leaving[which] = load[which] > 0 ? 1 : -1;
        }
        end[2 + which] = 0;
        memcpy(x, end, sizeof end);
        duration -= high;
        choose(self, x, leaving, mode);
        ++*events;
    }
}

static void compare(int system, uint32_t effects, double static_ratio, double dt, double tolerance,
                    int *visits)
{
    model self = {.system = system};
    self.scene = scene_of(system, MCT_STEPPER_TAYLOR6, effects);
    self.scene.dt = dt;
    static const double parameters[2][5] = {{0.3, 0.001, 1.5, 0.1, 4}, {0.005, 1e-6, 0.06, 0.12, 0.25}};
    for (int i = 0; i < 4; i++) {
        *parameter_of(&self.scene, names[system][DRAG + i]) = parameters[system][i];
    }
    const double size = parameters[system][4];
    if (system == REACTION_WHEEL) {
        *parameter_of(&self.scene, "wheel_inertia") = 1e-3; /* one that moves the arm before it spins fast */
    }
    *parameter_of(&self.scene, "static_ratio") = static_ratio;
    for (int i = 0; i < NAMES; i++) {
        self.p[i] = *parameter_of(&self.scene, names[system][i]);
    }
    self.wheel_inertia = system == REACTION_WHEEL ? *parameter_of(&self.scene, "wheel_inertia") : 0;
    for (int i = 0; i < 2; i++) {
        self.hold[i] = (real)static_ratio * self.p[SLIDE + i];
    }
    const int upright = system == CART_POLE ? 1 : 0;
    self.scene.initial[upright] = 3.141592653589793 - 1.2;
    self.scene.initial[2] = 0.4;
    self.scene.initial[3] = -3;
    mct_plant plant;
    start_plant(&plant, &self.scene);
    real x[4];
    for (int i = 0; i < 4; i++) {
        x[i] = (real)self.scene.initial[i];
    }
    int events = 0;
    double worst = 0;
    for (int k = 0; k < 24; k++) {
        self.u = size * sin(2.4 * k) * (k % 3 == 2 ? 0.1 : 1);
        advance(&self, 0.24L, x, visits, &events);
        step_plant(&plant, (mct_real)self.u, lround(0.24 / dt));
        for (int i = 0; i < 4; i++) {
            const double off = mct_plant_value(&plant, i) - (double)x[i];
            worst = fmax(worst, fabs(off) / (1 + fabs((double)x[i])));
        }
    }
    printf("%s, static ratio %g, %g ms: %d events, error %.1e\n", mct_systems[system]->name, static_ratio,
           1e3 * dt, events, worst);
    TEST_ASSERT_TRUE(events > 10);
    TEST_ASSERT_TRUE(worst <= tolerance);
}

/*
 * Tolerance: rounding, some 1e-16 in each of thousands of steps and events, and what the motion makes of it; at 6 ms what
 * the series of order 12 leaves out.
 */
static void test_both_coordinates_stick_and_slide_as_an_independent_integration_says(void)
{
    static const uint32_t effects[] = {MCT_GRAVITY | MCT_VISCOUS | MCT_COULOMB_EXACT,
                                       MCT_GRAVITY | MCT_VISCOUS | MCT_COULOMB_EXACT | MCT_DRAG};
    for (int system = 0; system < CENTRAL_SYSTEMS; system++) {
        int visits[9] = {0};
        for (int i = 0; i < 2; i++) {
            compare(system, effects[i], 1, 1e-3, 1e-12, visits);
            compare(system, effects[i], 1.4, 1e-3, 1e-12, visits);
            compare(system, effects[i], 1.4, 6e-3, 1e-9,
                    visits); /* of order 6: 6^6 times the error at 1 ms */
        }
        for (int k = 0; k < 9; k++) {
            printf("%d ", visits[k]);
        }
        printf("steps of the nine modes\n");
        for (int k = 0; k < 9; k++) {
            TEST_ASSERT_TRUE(visits[k] > 0);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_both_coordinates_stick_and_slide_as_an_independent_integration_says);
    return UNITY_END();
}
