/*
 * The falling sphere's motion against closed forms in long double (19 digits): exponential (Stokes), tangent
 * and hyperbolic tangent (drag, up and down), and the Riccati equation of both together.
 *
 * expo is exact: some roundings a step. What is left is 1e-13 of the size of the motion.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/scenes.h"
#include "unity.h"

typedef long double real;

#define PI 3.14159265358979323846264338L

void setUp(void)
{
}

void tearDown(void)
{
}

static int sphere(void)
{
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        if (strcmp(mct_systems[i]->name, "falling_sphere") == 0) {
            return i;
        }
    }
    return 0;
}

/* w' = a - B w - D w^2 for the speed w along its own direction, a, B, D >= 0 and w >= 0; D > 0. */
static void along(real a, real B, real D, real *x, real *w, real t)
{
    if (a == 0 && B == 0) {
        *x += log1pl(D * *w * t) / D;
        *w /= 1 + D * *w * t;
        return;
    }
    const real root = sqrtl(B * B + 4 * a * D);
    const real up = a > 0 ? 2 * a / (B + root) : 0; /* the terminal speed, without cancellation */
    const real down = -(B + root) / (2 * D);
    const real lambda = D * (up - down);
    const real K = (*w - up) / (*w - down);
    const real decay = expl(-lambda * t);
    *x += up * t + log1pl(K * -expm1l(-lambda * t) / (1 - K)) / D;
    *w = (up - down * K * decay) / (1 - K * decay);
}

/* From w > 0 against a deceleration a > 0, without Stokes: v = V tan(...), to the turn. Returns its time. */
static real climb(real a, real D, real *x, real w)
{
    const real V = sqrtl(a / D);
    *x += log1pl(w * w / (V * V)) / (2 * D);
    return atanl(w / V) / (V * D);
}

typedef struct {
    const char *name;
    uint32_t effects;
    double radius, density, fluid_density, viscosity, coefficient, v, u, tolerance;
} sphere_case;

static void test_five_seconds_of_motion_are_those_of_the_closed_form(void)
{
    static const uint32_t weights = MCT_GRAVITY | MCT_BUOYANCY;
    static const sphere_case cases[] = {
        {"fog droplet", weights | MCT_STOKES, 1e-5, 1000, 1.2, 17.9e-6, 0, 1, 1e-12, 1e-13},
        {"steel in glycerine", weights | MCT_STOKES, 1e-3, 7850, 1260, 1.42, 0, -0.5, 1e-5, 1e-13},
        {"hard: stiff", weights | MCT_STOKES, 3e-7, 1000, 1.2, 2e-5 * 10, 0, 10, 0, 1e-13},
        {"hailstone, up and down", weights | MCT_DRAG, 0.02, 900, 1.2, 0, 0.47, 20, 0.01, 1e-13},
        {"hard: drag at 1e6 m/s", MCT_DRAG, 0.02, 900, 1.2, 0, 0.47, -1e6, 0, 1e-12},
        {"stokes and drag", weights | MCT_STOKES | MCT_DRAG, 5e-4, 2000, 1000, 1e-3, 0.47, -0.3, 1e-7, 1e-13},
        {"bubble", weights | MCT_STOKES | MCT_DRAG, 5e-4, 1.2, 1000, 1e-3, 0.47, 0, 0, 1e-13},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const sphere_case *const c = &cases[i];
        const real r = c->radius;
        const real volume = 4 * PI / 3 * r * r * r;
        const real m = volume * c->density;
        real a = c->u / m;
        a -= (c->effects & MCT_GRAVITY) ? 9.81 : 0;
        a += (c->effects & MCT_BUOYANCY) ? 9.81 * volume * c->fluid_density / m : 0;
        const real B = (c->effects & MCT_STOKES) ? 6 * PI * c->viscosity * r / m : 0;
        const real D =
            (c->effects & MCT_DRAG) ? 0.5L * c->fluid_density * c->coefficient * PI * r * r / m : 0;
        real x = 0;
        real v = c->v;
        if (D == 0) {
            const real end = a / B;
            x = end * 5 - (v - end) * expm1l(-B * 5) / B;
            v = end + (v - end) * expl(-B * 5);
        } else {
            real t = 5;
            if (v * a < 0) {
                real risen = 0;
                t -= climb(fabsl(a), D, &risen, fabsl(v));
                x = v < 0 ? -risen : risen;
                v = 0;
            }
            const real side = v < 0 || (v == 0 && a < 0) ? -1 : 1;
            real moved = 0;
            real speed = fabsl(v);
            along(fabsl(a), B, D, &moved, &speed, t);
            x += side * moved;
            v = side * speed;
        }
        printf("%s, b h / m %.1e:", c->name, (double)B * 1e-3);
        FOR_EACH_STEPPER (stepper, sphere(), c->effects) {
            mct_scene scene = scene_of(sphere(), stepper, c->effects);
            *parameter_of(&scene, "radius") = c->radius;
            *parameter_of(&scene, "density") = c->density;
            *parameter_of(&scene, "fluid_density") = c->fluid_density;
            *parameter_of(&scene, "fluid_viscosity") = c->viscosity;
            *parameter_of(&scene, "drag_coefficient") = c->coefficient;
            scene.initial[1] = c->v;
            mct_plant plant;
            if (mct_plant_init(&plant, &scene, NULL) != MCT_OK) {
                printf(" %s refused", mct_steppers[stepper].name);
                continue;
            }
            step_plant(&plant, c->u, 5000);
            const double x_error = fabs(mct_plant_value(&plant, 0) - (double)x) / (1e-3 + (double)fabsl(x));
            const double v_error = fabs(mct_plant_value(&plant, 1) - (double)v) / (1e-3 + (double)fabsl(v));
            printf(" %s %.1e %.1e", mct_steppers[stepper].name, x_error, v_error);
            if (stepper == MCT_STEPPER_EXPO) {
                TEST_ASSERT_EQUAL_INT(0, plant.diverged_ticks);
                TEST_ASSERT_TRUE(x_error <= c->tolerance && v_error <= c->tolerance);
            }
        }
        printf("\n");
    }
}

/* (457) with buoyancy; without it, as printed. */
static void test_terminal_speed_is_that_of_equation_457_with_buoyancy(void)
{
    for (int buoyant = 0; buoyant < 2; buoyant++) {
        mct_scene scene =
            scene_of(sphere(), MCT_STEPPER_EXPO, MCT_GRAVITY | MCT_STOKES | (buoyant ? MCT_BUOYANCY : 0));
        mct_plant plant;
        start_plant(&plant, &scene);
        step_plant(&plant, 0, 1000);
        const double wanted = -2.0 / 9 * 9.81 * (7850 - (buoyant ? 1260 : 0)) / 1.42 * 1e-6;
        TEST_ASSERT_DOUBLE_WITHIN(1e-14 * 0.01, wanted, mct_plant_value(&plant, 1));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_five_seconds_of_motion_are_those_of_the_closed_form);
    RUN_TEST(test_terminal_speed_is_that_of_equation_457_with_buoyancy);
    return UNITY_END();
}
