/*
 * What a mechanism keeps when it moves by itself, and how much of it each stepper keeps: every system, from random
 * starts. What is kept is read off the evaluation: support/invariants.h. tools/bench --drift prints the same over 1e7
 * steps.
 *
 * Drifts are relative. What rounding alone does is allowed everywhere: 1000 roundings, for the evaluations that are
 * compared round, and so does the right-hand side of each step; compensated sums keep it from adding up.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/invariants.h"
#include "support/random.h"
#include "support/scenes.h"
#include "unity.h"

#define ROUNDING (1000 * (double)MCT_REAL_EPSILON)
enum { LOOK_EVERY = 101, STARTS = 3, SHORT = 10000, LONG = 200000 };

void setUp(void)
{
}

void tearDown(void)
{
}

typedef struct {
    mct_scene scene;
    mct_plant plant;
    invariants found;
} motion;

/* Motion number `start` of a system; false where there is none. */
static bool begin(motion *self, int system, int stepper, bool with_weight, int start)
{
    if (!invariant_scene(&self->scene, system, stepper, with_weight)) {
        return false;
    }
    test_random random = {(uint64_t)(1 + system * STARTS + start)};
    for (int i = 0; i < mct_state_count(&self->scene); i++) {
        self->scene.initial[i] += start > 0 ? random_in(&random, -0.1, 0.1) : 0;
    }
    start_plant(&self->plant, &self->scene);
    invariants_start(&self->found, &self->plant);
    return true;
}

/* Looks every `every` steps. */
static void go(motion *self, long steps, int every)
{
    for (long k = 1; k <= steps; k++) {
        mct_plant_step(&self->plant, 0);
        if (k % every == 0 || k == steps) {
            invariants_look(&self->found, &self->plant);
        }
    }
}

/* Calls `rule` for every system, stepper, weight and start. */
static void for_each_motion(void (*rule)(motion *self, const char *name))
{
    for (int system = 0; system < MCT_SYSTEM_COUNT; system++) {
        for (int stepper = 0; stepper < MCT_STEPPER_COUNT; stepper++) {
            for (int k = 0; k < 2 * STARTS; k++) {
                motion now;
                char name[96];
                if (begin(&now, system, stepper, k % 2 == 0, k / 2)) {
                    snprintf(name, sizeof name, "%s, %s, %s, start %d", mct_systems[system]->name,
                             mct_steppers[stepper].name, k % 2 == 0 ? "heavy" : "weightless", k / 2);
                    rule(&now, name);
                }
            }
        }
    }
}

static void check(bool holds, const char *name, int kind, double found, double allowed)
{
    if (!holds) {
        printf("%s: %s drifts by %.1e; allowed %.1e\n", name, kept_names[kind], found, allowed);
        TEST_FAIL_MESSAGE(name);
    }
}

/* --- rules --- */

/* Each step makes it 1 again, but for a rounding of each of its entries. */
static void length_rule(motion *self, const char *name)
{
    if (!self->found.is_kept[KEPT_LENGTH]) {
        return;
    }
    go(self, LONG, LOOK_EVERY);
    if (self->scene.stepper == MCT_STEPPER_SEED && self->plant.diverged_ticks > 0) {
        return; /* it gains energy until it blows up */
    }
    const double allowed = 4 * (double)MCT_REAL_EPSILON;
    check(self->found.drift[KEPT_LENGTH] <= allowed, name, KEPT_LENGTH, self->found.drift[KEPT_LENGTH],
          allowed);
}

static void test_a_quaternion_keeps_its_length_for_ever(void)
{
    for_each_motion(length_rule);
}

/* Over the same seconds, seen at the same times; half is allowed for the next powers of the step. */
static void order_rule(motion *self, const char *name)
{
    motion fine = *self;
    fine.scene.dt /= 2;
    start_plant(&fine.plant, &fine.scene);
    invariants_start(&fine.found, &fine.plant);
    go(self, SHORT, LOOK_EVERY);
    go(&fine, 2 * SHORT, 2 * LOOK_EVERY);
    for (int kind = 0; kind < KEPT_LENGTH; kind++) {
        const double coarse = self->found.drift[kind];
        const double allowed = 1.5 * coarse / pow(2, mct_steppers[self->scene.stepper].order) + ROUNDING;
        if (self->found.is_kept[kind] && coarse < 0.01) { /* else the step is too long for what it does */
            check(fine.found.drift[kind] <= allowed, name, kind, fine.found.drift[kind], allowed);
        }
    }
}

static void test_half_the_step_divides_the_drift_as_the_order_says(void)
{
    for_each_motion(order_rule);
}

/* Where all coordinates but one have a momentum that is kept, that one swings or turns: the motion repeats itself. */
static bool repeats(const motion *self)
{
    const mct_system *system = self->plant.system;
    int left = system->coordinate_count;
    for (int i = 0; i < system->coordinate_count; i++) {
        left -= self->found.is_momentum[i] ? 1 : 0;
    }
    return system->attitude == MCT_ATTITUDE_NONE && !(self->plant.effects & MCT_CORIOLIS) && left <= 1;
}

static bool has_constant_mass(const motion *self)
{
    mct_evaluation now;
    bool constant = true;
    mct_plant_evaluate(&self->plant, &now);
    for (int i = 0; i < self->plant.system->coordinate_count; i++) {
        constant &= now.Cv[i] == 0;
    }
    return constant;
}

/*
 * By what the scheme keeps instead. leap, symmetric in time, and euler, symplectic while the mass matrix is constant,
 * keep a quantity near the energy: their drift is there within a period and stays. rk4 and expo keep none: each period
 * adds the same.
 */
static void growth_rule(motion *self, const char *name)
{
    const int stepper = self->scene.stepper;
    const bool is_bounded =
        stepper == MCT_STEPPER_LEAP || (stepper == MCT_STEPPER_EULER && has_constant_mass(self));
    if (stepper == MCT_STEPPER_SEED || !repeats(self) || !(is_bounded || stepper > MCT_STEPPER_LEAP)) {
        return;
    }
    go(self, LONG / 10, LOOK_EVERY);
    const invariants before = self->found;
    go(self, LONG - LONG / 10, LOOK_EVERY);
    for (int kind = 0; kind < KEPT_LENGTH; kind++) {
        const double allowed = (is_bounded ? 1.2 : 12) * before.drift[kind] + ROUNDING;
        if (before.is_kept[kind]) {
            check(self->found.drift[kind] <= allowed && allowed < 1, name, kind, self->found.drift[kind],
                  allowed);
        }
    }
}

static void test_leap_and_euler_stay_near_the_energy_and_the_others_leave_it_no_faster_than_time(void)
{
    for_each_motion(growth_rule);
}

/* --- seed --- */

/* Of a system of one coordinate, at rest at q. */
static void evaluate_at(const mct_plant *plant, double q, mct_evaluation *out)
{
    const double values[MCT_MAX_STATES] = {q};
    mct_state state;
    mct_state_set(plant->system, plant->states, values, &state);
    plant->system->evaluate(&plant->constants, plant->effects, state.x, 0, out);
}

/* Where the potential energy is least, to a thousandth of the range of +-pi that is searched. */
static double lowest(const mct_plant *plant)
{
    double found = 0, least = INFINITY;
    for (int k = -1000; k <= 1000; k++) {
        mct_evaluation now;
        evaluate_at(plant, 3.141592653589793 * k / 1000, &now);
        if ((double)now.potential_energy < least) {
            least = (double)now.potential_energy;
            found = 3.141592653589793 * k / 1000;
        }
    }
    return found;
}

/*
 * The amplitude grows at w^2 h / 4: by e in 4 / (w^2 h) seconds. Its logarithm is off by w h, for what the scheme sees as
 * energy is that much off the energy, and w^2 by a tenth of the square of the amplitude: 0.14 at the end.
 */
static void test_seed_is_anti_damped_at_the_rate_that_theory_gives(void)
{
    int oscillators = 0;
    for (int system = 0; system < MCT_SYSTEM_COUNT; system++) {
        const double e = 0.05;
        mct_evaluation left, middle, right;
        motion now;
        if (mct_systems[system]->coordinate_count != 1 || !begin(&now, system, MCT_STEPPER_SEED, true, 0)) {
            continue;
        }
        const double q = lowest(&now.plant);
        evaluate_at(&now.plant, q - e, &left);
        evaluate_at(&now.plant, q, &middle);
        evaluate_at(&now.plant, q + e, &right);
        const double square = (double)(left.tau[0] - right.tau[0]) / (2 * e) / (double)middle.M[0][0];
        if (!(square > 0.1)) {
            continue; /* nothing holds it */
        }
        oscillators++;
        memset(now.scene.initial, 0, sizeof now.scene.initial);
        now.scene.initial[0] = q + e;
        start_plant(&now.plant, &now.scene);
        const double before = energy_of(&now.plant) - (double)middle.potential_energy;
        step_plant(&now.plant, 0, lround(4 / (square * now.scene.dt * now.scene.dt)));
        const double grown = 0.5 * log((energy_of(&now.plant) - (double)middle.potential_energy) / before);
        printf("%s: in the time in which theory lets it grow by e, by e^%.3f\n", mct_systems[system]->name,
               grown);
        TEST_ASSERT_DOUBLE_WITHIN(0.01 + sqrt(square) * now.scene.dt, 1, grown);
    }
    TEST_ASSERT_GREATER_THAN(3, oscillators);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_quaternion_keeps_its_length_for_ever);
    RUN_TEST(test_half_the_step_divides_the_drift_as_the_order_says);
    RUN_TEST(test_leap_and_euler_stay_near_the_energy_and_the_others_leave_it_no_faster_than_time);
    RUN_TEST(test_seed_is_anti_damped_at_the_rate_that_theory_gives);
    return UNITY_END();
}
