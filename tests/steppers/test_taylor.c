/* Taylor's method: how far it follows a motor, where it does not suit, and that nobody gets it unasked; its rounding. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/textbook.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

/* --- the motor --- */

/* What a scheme of this order makes of e^-z. */
static double polynomial(int order, double z)
{
    double sum = 1, term = 1;
    for (int n = 1; n <= order; n++) {
        term *= -z / n;
        sum += term;
    }
    return sum;
}

/* The first z at which it leaves +-1, by steps of 1e-5. */
static double boundary(int order)
{
    double z = 1;
    while (fabs(polynomial(order, z)) <= 1) {
        z += 1e-5;
    }
    return z;
}

static void test_a_motors_limit_is_where_the_polynomial_of_its_order_leaves_the_unit_interval(void)
{
    int limits = 0;
    for (int stepper = 0; stepper < MCT_STEPPER_COUNT; stepper++) {
        const mct_stepper *const self = &mct_steppers[stepper];
        if (self->motor_stability_limit > 0) {
            const double exact = boundary(self->order);
            printf("%s: h R/L up to %.4f\n", self->name, exact);
            TEST_ASSERT_TRUE(self->motor_stability_limit <= exact);
            TEST_ASSERT_TRUE(self->motor_stability_limit > exact - 1.1e-3); /* three digits, rounded down */
            limits++;
        }
    }
    TEST_ASSERT_EQUAL_INT(6, limits);
}

/* The current of a motor without back-EMF, at rest, after 4000 steps; 1 A at the start. */
static double current_after(int stepper, double stiffness)
{
    mct_scene scene = scene_of(REACTION_WHEEL, stepper, MCT_MOTOR_INDUCTIVE);
    mct_plant plant;
    *parameter_of(&scene, "back_emf_constant") = 0;
    *parameter_of(&scene, "torque_constant") = 0;
    *parameter_of(&scene, "inductance") = scene.dt * *parameter_of(&scene, "resistance") / stiffness;
    scene.initial[4] = 1;
    start_plant(&plant, &scene);
    step_plant(&plant, 0, 4000);
    return fabs(mct_plant_value(&plant, 4));
}

/* One in a thousand beside the limit is e^4 or more after 4000 steps. */
static void test_a_current_decays_just_below_the_limit_and_grows_just_above(void)
{
    FOR_EACH_STEPPER (stepper, REACTION_WHEEL, MCT_MOTOR_INDUCTIVE) {
        const double limit = mct_steppers[stepper].motor_stability_limit;
        if (limit > 0) {
            TEST_ASSERT_TRUE(current_after(stepper, 0.998 * limit) < 0.1);
            TEST_ASSERT_TRUE(current_after(stepper, 1.002 * limit) > 10);
        }
    }
}

/* --- scenes --- */

static void test_a_series_is_refused_where_friction_has_a_kink_and_the_message_says_so(void)
{
    static const struct {
        const char *system;
        uint32_t effect;
    } kinks[] = {{"cart_pole", MCT_COULOMB_MOREAU},         {"reaction_wheel", MCT_COULOMB_MOREAU},
                 {"pendulum", MCT_COULOMB_MOREAU},          {"pendulum", MCT_DRAG},
                 {"fixed_axis", MCT_COULOMB_MOREAU},        {"solid_pendulum", MCT_COULOMB_MOREAU},
                 {"particle_pendulum", MCT_COULOMB_MOREAU}, {"rigid_body", MCT_DRAG}};
    for (size_t i = 0; i < sizeof kinks / sizeof kinks[0]; i++) {
        const int system = system_called(kinks[i].system);
        mct_scene scene;
        mct_message why = {""};
        mct_scene_defaults(&scene, system);
        scene.stepper = MCT_STEPPER_TAYLOR6;
        scene.effects &= ~(uint32_t)MCT_MOTOR; /* whose default is too fast for a millisecond */
        TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, mct_scene_check(&scene, &why), why.text);
        scene.effects |= kinks[i].effect;
        TEST_ASSERT_EQUAL_INT(MCT_ERROR_UNSUITED, mct_scene_check(&scene, &why));
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "found taylor6, which does not suit "), why.text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, ", for a series ends where friction has a kink"),
                                     why.text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "; allowed seed, "), why.text);
        TEST_ASSERT_NULL_MESSAGE(strstr(strstr(why.text, "allowed"), "taylor"), why.text);
        const bool has_exact = (mct_systems[system]->effects & MCT_COULOMB_EXACT) != 0;
        TEST_ASSERT_EQUAL(has_exact, strstr(why.text, "unless coulomb = \"exact\" finds it") != NULL);
        if (has_exact) {
            scene.effects = (scene.effects & ~(uint32_t)MCT_COULOMB) | MCT_COULOMB_EXACT;
            TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, mct_scene_check(&scene, &why), why.text);
        }
    }
}

static void test_a_scene_that_names_no_stepper_gets_no_series(void)
{
    for (int system = 0; system < MCT_SYSTEM_COUNT; system++) {
        mct_scene scene;
        mct_scene_defaults(&scene, system);
        TEST_ASSERT_FALSE(mct_steppers[scene.stepper].is_special);
    }
    mct_scene scene;
    mct_message why;
    const char text[] = "[scene]\nsystem = \"pendulum\"\n";
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_scene_read(text, sizeof text - 1, "t", NULL, 0, &scene, &why));
    TEST_ASSERT_EQUAL_INT(MCT_STEPPER_RK4, scene.stepper);
}

/* --- rounding --- */

/* Largest error at every second of ten. */
static double error_of(const mct_scene *scene, double input)
{
    textbook book;
    mct_plant plant;
    quad x[QUAD_MAX_STATES];
    double worst = 0;
    TEST_ASSERT_TRUE(textbook_of(&book, scene, input));
    start_plant(&plant, scene);
    textbook_start(&book, &plant, x);
    for (int second = 0; second < 10; second++) {
        quad_extrapolate(book.rate, &book, second, x, book.states, 1, 20);
        step_plant(&plant, (mct_real)input, lround(1 / scene->dt));
        worst = fmax(worst, textbook_distance(&book, &plant, x));
    }
    return worst;
}

/*
 * At 1 kHz no series but that of order 4 has an error of its own, 1e-9 at most: what is left is rounding, amplified by the
 * motion. In float that is as much with rk4; a factor of 3 is luck.
 */
static void test_at_a_kilohertz_only_rounding_is_left(void)
{
    static const struct {
        const char *name;
        double initial[MCT_MAX_STATES];
    } motions[] = {
        {"cart_pole", {0, 2}},
        {"reaction_wheel", {2}},
        {"pendulum", {2}},
        {"particle_pendulum", {1}},
        {"fixed_axis", {1}},
        {"solid_pendulum", {0.5}},
        {"spring_pendulum", {0.42, 0, 0, 1}},
        {"ball_joint", {1, 0, 0, 0.2, 1, 8, 0}},
    };
    for (size_t i = 0; i < sizeof motions / sizeof motions[0]; i++) {
        mct_scene scene;
        mct_scene_defaults(&scene, system_called(motions[i].name));
        scene.effects &= ~(uint32_t)MCT_MOTOR;
        memcpy(scene.initial, motions[i].initial, sizeof motions[i].initial);
        scene.stepper = MCT_STEPPER_RK4;
        const double rk4 = error_of(&scene, 0);
        printf("%-17s rk4 %.1e", motions[i].name, rk4);
        for (int stepper = MCT_STEPPER_TAYLOR6; stepper <= MCT_STEPPER_TAYLOR12; stepper++) {
            scene.stepper = stepper;
            const double error = error_of(&scene, 0);
            printf("  %s %.1e", mct_steppers[stepper].name, error);
            TEST_ASSERT_TRUE(error < (MCT_REAL_IS_FLOAT ? 3 * rk4 + 1e-7 : 1e-11));
        }
        printf("\n");
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_motors_limit_is_where_the_polynomial_of_its_order_leaves_the_unit_interval);
    RUN_TEST(test_a_current_decays_just_below_the_limit_and_grows_just_above);
    RUN_TEST(test_a_series_is_refused_where_friction_has_a_kink_and_the_message_says_so);
    RUN_TEST(test_a_scene_that_names_no_stepper_gets_no_series);
    RUN_TEST(test_at_a_kilohertz_only_rounding_is_left);
    return UNITY_END();
}
