/*
 * The block's motion over seconds against closed forms: the textbook's benchmarks of dry friction, and its
 * phases of sticking and sliding put together in long double (19 digits), with events by bisection.
 *
 * Tolerances: expo is exact between events and, with exact friction, locates these to rounding, so what is left are some roundings
 * of each of thousands of steps: 1e-14 of motions of the size of 1. Moreau's clamp errs by the square of the
 * step at a stop, and by the friction of a step at a break-away.
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

static int block(void)
{
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        if (strcmp(mct_systems[i]->name, "block") == 0) {
            return i;
        }
    }
    return 0;
}

/* --- the benchmarks --- */

static double stop_error(int stepper, uint32_t coulomb, double dt)
{
    mct_scene scene = scene_of(block(), stepper, MCT_GRAVITY | coulomb);
    scene.dt = dt;
    scene.initial[1] = 2.0007;
    mct_plant plant;
    start_plant(&plant, &scene);
    step_plant(&plant, 0, lround(2 / dt));
    TEST_ASSERT_TRUE(plant.state.x[1] == 0);
    return mct_plant_value(&plant, 0) - 2.0007 * 2.0007 / (2 * 0.5 * 9.81);
}

static void test_a_sliding_block_stops_after_v2_over_2_mu_g(void)
{
    static const uint32_t kinds[] = {MCT_COULOMB_MOREAU, MCT_COULOMB_EXACT};
    for (int i = 0; i < 2; i++) {
        FOR_EACH_STEPPER (stepper, block(), MCT_GRAVITY | kinds[i]) {
            const double error = stop_error(stepper, kinds[i], 1e-3);
            printf("stop, %s, %s: %.1e m, at h/2 %.1e m\n", i == 0 ? "moreau" : "exact",
                   mct_steppers[stepper].name, error, stop_error(stepper, kinds[i], 5e-4));
            /* the clamp: at most mu g h^2 / 8, in the step of the stop */
            TEST_ASSERT_DOUBLE_WITHIN(i == 1 ? 1e-14 : 0.5 * 9.81 * 1e-6 / 8 + 1e-12, 0, error);
        }
    }
}

/* Moreau's by a stepper of second order, and exact: what each may err by. */
static const struct {
    const char *name;
    uint32_t effect;
    int stepper;
    double rest;   /* [m] of 1 m */
    double period; /* relative */
} schemes[] = {{"moreau, leap", MCT_COULOMB_MOREAU, MCT_STEPPER_LEAP, 1.05e-5, 1.45e-4},
               {"moreau, rk4", MCT_COULOMB_MOREAU, MCT_STEPPER_RK4, 1.05e-5, 1.45e-4},
               {"exact, expo", MCT_COULOMB_EXACT, MCT_STEPPER_EXPO, 1e-13, 1e-13}};
/* The block of 1 kg on a spring of 100 N/m by which the schemes were once measured: static and dynamic friction [N]. */
static mct_scene measured_scene(int scheme, double hold, double slide)
{
    mct_scene scene =
        scene_of(block(), schemes[scheme].stepper, MCT_GRAVITY | schemes[scheme].effect | MCT_SPRING);
    *parameter_of(&scene, "gravity") = 10;
    *parameter_of(&scene, "static_coefficient") = hold / 10;
    *parameter_of(&scene, "dynamic_coefficient") = slide / 10;
    return scene;
}
enum { SCHEMES = sizeof schemes / sizeof schemes[0] };

/* Each half oscillation loses 2 F_d / k of amplitude. */
static void check_spring(int scheme)
{
    mct_scene scene = measured_scene(scheme, 5, 4);
    const double lost = 2 * 4 / 100.0;
    double rest = 1;
    int half_cycles = 0;
    while (fabs(100 * rest) > 5) {
        rest = -(rest - (rest > 0 ? lost : -lost));
        half_cycles++;
    }
    scene.initial[0] = 1;
    mct_plant plant;
    start_plant(&plant, &scene);
    step_plant(&plant, 0, 10000);
    printf("spring, %s: at rest at %.15f m after %d half cycles, error %.1e\n", schemes[scheme].name,
           mct_plant_value(&plant, 0), half_cycles, mct_plant_value(&plant, 0) - rest);
    TEST_ASSERT_TRUE(plant.state.x[1] == 0);
    TEST_ASSERT_DOUBLE_WITHIN(schemes[scheme].rest, rest, mct_plant_value(&plant, 0));
    const mct_state before = plant.state;
    step_plant(&plant, 0, 100000);
    TEST_ASSERT_EQUAL_MEMORY(&before, &plant.state, sizeof before); /* not a bit in 100 s */
}

static void test_a_spring_loses_2_mu_n_over_k_each_half_cycle(void)
{
    for (int scheme = 0; scheme < SCHEMES; scheme++) {
        check_spring(scheme);
    }
}

/* T = (2 pi - 2 atan(D w / b)) / w + 2 D / b with D = (F_s - F_d) / k. */
static void check_belt(int scheme)
{
    mct_scene scene = measured_scene(scheme, 6, 4);
    *parameter_of(&scene, "belt_speed") = 0.1;
    scene.initial[1] = 0.1;
    const double D = 2 / 100.0;
    const double period = (2 * M_PI - 2 * atan(D * 10 / 0.1)) / 10 + 2 * D / 0.1;
    mct_plant plant;
    start_plant(&plant, &scene);
    double first = 0;
    double last = 0;
    int cycles = 0;
    double before = 0;
    for (long k = 1; k <= 200000; k++) {
        mct_plant_step(&plant, 0);
        const double x = mct_plant_value(&plant, 0);
        const double middle = 4 / 100.0; /* carried through it at exactly the belt's speed */
        if (before < middle && x >= middle) {
            last = (double)k * 1e-3 - (x - middle) / 0.1;
            first = cycles == 0 ? last : first;
            cycles++;
        }
        before = x;
    }
    const double measured = (last - first) / (cycles - 1);
    printf("belt, %s: period %.15f s, relative error %.1e over %d cycles\n", schemes[scheme].name, measured,
           measured / period - 1, cycles);
    TEST_ASSERT_DOUBLE_WITHIN(schemes[scheme].period * period, period, measured);
}

static void test_stick_slip_on_a_belt_has_its_period(void)
{
    for (int scheme = 0; scheme < SCHEMES; scheme++) {
        check_belt(scheme);
    }
}

/* F = r t breaks away at F_s / r, then m x = r t^3 / 6 + (F_s - F_d) t^2 / 2. */
static void test_a_ramp_breaks_away_at_static_friction(void)
{
    mct_scene scene = scene_of(block(), MCT_STEPPER_EXPO, MCT_GRAVITY | MCT_COULOMB_EXACT | MCT_FORCING);
    *parameter_of(&scene, "force_ramp") = -1.7;
    mct_plant plant;
    start_plant(&plant, &scene);
    step_plant(&plant, 0, 5000);
    const double t = 5 - 0.6 * 9.81 / 1.7;
    const double v = -(1.7 * t * t / 2 + 0.1 * 9.81 * t);
    const double x = -(1.7 * t * t * t / 6 + 0.1 * 9.81 * t * t / 2);
    printf("ramp: errors %.1e m, %.1e m/s\n", mct_plant_value(&plant, 0) - x, mct_plant_value(&plant, 1) - v);
    TEST_ASSERT_DOUBLE_WITHIN(1e-13, x, mct_plant_value(&plant, 0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-13, v, mct_plant_value(&plant, 1));
}

/*
 * A force whose peak alone exceeds what holds, within one step: the sine of 0.9 rad a step starts 0.4 before
 * its top.
 */
static void test_a_peak_within_a_step_breaks_away(void)
{
    mct_scene scene = scene_of(block(), MCT_STEPPER_EXPO, MCT_GRAVITY | MCT_COULOMB_EXACT | MCT_FORCING);
    *parameter_of(&scene, "force_amplitude") = 0.6 * 9.81 / sin(M_PI / 2 - 0.3);
    *parameter_of(&scene, "force_frequency") = 900;
    scene.initial[2] = M_PI / 2 - 0.4;
    mct_plant plant;
    start_plant(&plant, &scene);
    step_plant(&plant, 0, 1);
    const real w = 900;
    const real A = *parameter_of(&scene, "force_amplitude");
    const real from = M_PI / 2 - 0.3L; /* in the phase */
    const real to = (real)M_PI / 2 + 0.5L;
    const real v = A / w * (cosl(from) - cosl(to)) - 0.5L * 9.81L * (to - from) / w;
    TEST_ASSERT_TRUE(v > 0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12 * (double)v + 1e-16, (double)v, mct_plant_value(&plant, 1));
}

/* --- any motion, piece by piece --- */

typedef struct {
    real m, k, gravity_force, hold, slide, belt, F0, ramp, A, W, u;
} model;

typedef struct {
    real x, v, t;
} point;

static real outer_force(const model *p, real t)
{
    return p->u + p->gravity_force + p->F0 + p->ramp * t + p->A * sinl(p->W * t);
}

/*
 * From `from` to time t under a constant friction: particular solution plus free oscillation, or plain
 * integrals.
 */
static point slide_to(const model *p, point from, real dry, real t)
{
    const real c = p->u + p->gravity_force + p->F0 + dry;
    const real tau = t - from.t;
    if (p->k == 0) {
        const real s = p->A == 0 ? 0 : p->A / p->W;
        const real a0 = c + p->ramp * from.t;
        const real phase = p->W * from.t;
        const real v =
            from.v + (a0 * tau + p->ramp * tau * tau / 2 + s * (cosl(phase) - cosl(p->W * t))) / p->m;
        const real x = from.x + from.v * tau +
                       (a0 * tau * tau / 2 + p->ramp * tau * tau * tau / 6 + s * cosl(phase) * tau -
                        s / p->W * (sinl(p->W * t) - sinl(phase))) /
                           p->m;
        return (point){x, v, t};
    }
    const real w = sqrtl(p->k / p->m);
    const real forced = p->A / (p->m * (w * w - p->W * p->W));
    const real x0 = (c + p->ramp * from.t) / p->k + forced * sinl(p->W * from.t);
    const real v0 = p->ramp / p->k + forced * p->W * cosl(p->W * from.t);
    const real B = from.x - x0;
    const real S = (from.v - v0) / w;
    const real x = (c + p->ramp * t) / p->k + forced * sinl(p->W * t) + B * cosl(w * tau) + S * sinl(w * tau);
    const real v =
        p->ramp / p->k + forced * p->W * cosl(p->W * t) - B * w * sinl(w * tau) + S * w * cosl(w * tau);
    return (point){x, v, t};
}

/* Above 0 while the phase lasts. */
static real margin(const model *p, point from, int direction, real t)
{
    if (direction == 0) {
        return p->hold - fabsl(outer_force(p, t) - p->k * (from.x + p->belt * (t - from.t)));
    }
    return (real)direction * (slide_to(p, from, -(real)direction * p->slide, t).v - p->belt);
}

static point reference(const model *p, point now, real end, real scan, int *events)
{
    int direction = now.v > p->belt ? 1 : now.v < p->belt ? -1 : 0;
    *events = 0;
    while (now.t < end) {
        real good = now.t;
        real t = now.t;
        bool ended = false;
        while (t < end && !ended) {
            t = fminl(t + scan, end);
            ended = margin(p, now, direction, t) < 0;
            good = ended ? good : t;
        }
        if (ended) {
            for (int i = 0; i < 80; i++) {
                const real middle = (good + t) / 2;
                if (margin(p, now, direction, middle) < 0) {
                    t = middle;
                } else {
                    good = middle;
                }
            }
            ++*events;
        }
        now = direction == 0 ? (point){now.x + p->belt * (t - now.t), p->belt, t}
                             : slide_to(p, now, -(real)direction * p->slide, t);
        if (ended) {
            const real force = outer_force(p, t) - p->k * now.x;
            now.v = p->belt;
            const bool holds = direction != 0 && fabsl(force) <= p->hold;
            direction = holds ? 0 : force > 0 ? 1 : -1;
        }
    }
    return now;
}

typedef struct {
    const char *name;
    double mass, hold, slide, slope, force, ramp, amplitude, frequency, spring, belt, x, v, u, scan,
        tolerance;
} motion_case;

static void test_five_seconds_of_motion_are_those_of_the_closed_form(void)
{
    static const motion_case cases[] = {
        {"shaken on a slope", 1.3, 0.6, 0.5, 0.2, 0.3, 0.05, 9, 4.7, 0, 0, 0.1, 0.7, 0.25, 1e-4, 1e-14},
        {"shaken on a belt", 0.7, 0.7, 0.4, -0.1, 0.5, -0.2, 2.5, 7, 80, 0.15, 0.02, -0.3, -0.4, 1e-4, 1e-15},
        /*
         * hard: half a radian of oscillation and 0.3 rad of force a step, sticking and sliding within a step
         */
        {"hard: rattles", 1, 0.9, 0.3, 0.05, 1, 0.5, 30, 311, 2.5e5, 0.02, 3e-4, 0.1, 0.3, 1e-5, 1e-15},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const motion_case *const c = &cases[i];
        const uint32_t smooth = MCT_GRAVITY | MCT_FORCING | (c->spring > 0 ? MCT_SPRING : 0);
        const model p = {c->mass,
                         c->spring,
                         -(real)c->mass * 9.81 * sinl(c->slope),
                         (real)c->hold * c->mass * 9.81 * cosl(c->slope),
                         (real)c->slide * c->mass * 9.81 * cosl(c->slope),
                         c->belt,
                         c->force,
                         c->ramp,
                         c->amplitude,
                         c->frequency,
                         c->u};
        int events;
        const point truth = reference(&p, (point){c->x, c->v, 0}, 5, c->scan, &events);
        /* The reference does not depend on how it is scanned: no event was missed. */
        int again;
        const point finer = reference(&p, (point){c->x, c->v, 0}, 5, c->scan / 3, &again);
        TEST_ASSERT_EQUAL_INT(events, again);
        TEST_ASSERT_DOUBLE_WITHIN(1e-15, (double)truth.x, (double)finer.x);
        printf("%s, %d events:", c->name, events);
        FOR_EACH_STEPPER (stepper, block(), smooth | MCT_COULOMB_MOREAU) {
            const bool is_exact = stepper == MCT_STEPPER_EXPO;
            const uint32_t effects = smooth | (is_exact ? MCT_COULOMB_EXACT : MCT_COULOMB_MOREAU);
            mct_scene scene = scene_of(block(), stepper, effects);
            *parameter_of(&scene, "mass") = c->mass;
            *parameter_of(&scene, "static_coefficient") = c->hold;
            *parameter_of(&scene, "dynamic_coefficient") = c->slide;
            *parameter_of(&scene, "slope") = c->slope;
            *parameter_of(&scene, "force") = c->force;
            *parameter_of(&scene, "force_ramp") = c->ramp;
            *parameter_of(&scene, "force_amplitude") = c->amplitude;
            *parameter_of(&scene, "force_frequency") = c->frequency;
            *parameter_of(&scene, "spring") = c->spring;
            *parameter_of(&scene, "belt_speed") = c->belt;
            scene.initial[0] = c->x;
            scene.initial[1] = c->v;
            mct_plant plant;
            start_plant(&plant, &scene);
            step_plant(&plant, c->u, 5000);
            const double w = c->spring > 0 ? sqrt(c->spring / c->mass) : 1;
            const double error = fmax(fabs(mct_plant_value(&plant, 0) - (double)truth.x),
                                      fabs(mct_plant_value(&plant, 1) - (double)truth.v) / w);
            printf(" %s %.1e", mct_steppers[stepper].name, error);
            if (is_exact) {
                TEST_ASSERT_TRUE(error <= c->tolerance);
            }
        }
        printf("\n");
    }
}

/* Without friction the spring's energy stays, however long. */
static void test_the_oscillator_keeps_its_energy(void)
{
    mct_scene scene = scene_of(block(), MCT_STEPPER_EXPO, MCT_SPRING);
    *parameter_of(&scene, "spring") = 1e5; /* 0.3 rad a step */
    scene.initial[0] = 1;
    mct_plant plant;
    start_plant(&plant, &scene);
    step_plant(&plant, 0, 1000000);
    printf("oscillator: energy after 1e6 steps %.1e\n", energy_of(&plant) / 5e4 - 1);
    TEST_ASSERT_DOUBLE_WITHIN(1e-11, 1,
                              energy_of(&plant) / 5e4); /* a rounding of each step's coefficients adds up */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_sliding_block_stops_after_v2_over_2_mu_g);
    RUN_TEST(test_a_spring_loses_2_mu_n_over_k_each_half_cycle);
    RUN_TEST(test_stick_slip_on_a_belt_has_its_period);
    RUN_TEST(test_a_ramp_breaks_away_at_static_friction);
    RUN_TEST(test_a_peak_within_a_step_breaks_away);
    RUN_TEST(test_five_seconds_of_motion_are_those_of_the_closed_form);
    RUN_TEST(test_the_oscillator_keeps_its_energy);
    return UNITY_END();
}
