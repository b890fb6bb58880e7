/*
 * The ledger of energy over a run: what the effects' powers add up to is what the energy changes by.
 *
 * Powers are summed by the trapezoidal rule within each tick, the voltage being held over it, so its left and
 * its right limit count. The sum is off by h^2/12 times the change of the power's slope, so halving the tick
 * divides the gap by four; where a tick is not short against L/R, the current's own jump is not resolved, and
 * the motor is taken slow here.
 */
#include <math.h>
#include <stdio.h>

#include "support/scenes.h"
#include "unity.h"

#define DURATION 4.0

void setUp(void)
{
}

void tearDown(void)
{
}

typedef struct {
    double input, viscous, coulomb, resistance, conversion;
} ledger;

static double power_of(const mct_plant *plant, mct_real input, ledger *sum, double weight)
{
    mct_evaluation now;
    plant->system->evaluate(&plant->constants, plant->effects, plant->state.x, input, &now);
    sum->input += weight * now.power_input;
    sum->viscous += weight * now.power_viscous;
    sum->coulomb += weight * now.power_coulomb;
    sum->resistance += weight * now.power_resistance;
    sum->conversion += weight * now.power_conversion;
    return now.kinetic_energy + now.potential_energy + now.magnetic_energy;
}

/* Gap between energy and ledger at the end, relative to all work that was done. */
static double gap_of(mct_scene scene, double dt, bool print)
{
    scene.dt = dt;
    mct_plant plant;
    start_plant(&plant, &scene);
    ledger sum = {0};
    ledger none = {0};
    const double before = power_of(&plant, 0, &none, 0);
    const long ticks = lround(DURATION / dt);
    const long held = lround(2e-3 / dt); /* the same voltages at any tick */
    for (long k = 0; k < ticks; k++) {
        const double volts = (scene.effects & MCT_MOTOR) ? 6 : scene.system == CART_POLE ? 2 : 0.01;
        const mct_real u = volts * sin(3.0 * 2e-3 * (double)(k / held));
        power_of(&plant, u, &sum, dt / 2);
        mct_plant_step(&plant, u);
        power_of(&plant, u, &sum, dt / 2);
    }
    const double change = power_of(&plant, 0, &none, 0) - before;
    const double total = sum.input + sum.viscous + sum.coulomb + sum.resistance + sum.conversion;
    const double size = fabs(sum.input) + fabs(sum.viscous) + fabs(sum.coulomb) + fabs(sum.resistance) +
                        fabs(sum.conversion) + 1e-3;
    if (print) {
        printf("%s, %s: energy %+.4f J = input %+.4f viscous %+.4f coulomb %+.4f resistance %+.4f conversion "
               "%+.4f",
               mct_systems[scene.system]->name, motor_name(scene.effects), change, sum.input, sum.viscous,
               sum.coulomb, sum.resistance, sum.conversion);
    }
    return fabs(change - total) / size;
}

static mct_scene scene_with(int system, uint32_t effects)
{
    mct_scene scene = scene_of(system, system == CART_POLE ? MCT_STEPPER_RK4 : MCT_STEPPER_EXPO, effects);
    scene.initial[mct_systems[system]->actuation->upright_coordinate] = 2.5;
    *parameter_of(&scene, "inductance") = 0.05 * *parameter_of(&scene, "resistance");
    *parameter_of(&scene, "back_emf_constant") *= 0.8; /* so that conversion has something to say */
    return scene;
}

static void test_the_works_of_all_effects_add_up_to_the_change_of_energy(void)
{
    static const uint32_t motors[] = {0, MCT_MOTOR_QUASI_STATIC, MCT_MOTOR_INDUCTIVE};
    for (int system = 0; system < CENTRAL_SYSTEMS; system++) {
        for (int k = 0; k < 3; k++) {
            const mct_scene scene = scene_with(system, MCT_GRAVITY | MCT_VISCOUS | motors[k]);
            const double coarse = gap_of(scene, 1e-3, true);
            const double fine = gap_of(scene, 0.5e-3, false);
            printf("; gap %.1e, halved %.1e\n", coarse, fine);
            TEST_ASSERT_TRUE(coarse < 1e-5);
            TEST_ASSERT_TRUE(fine < coarse / 3.5 || fine < 1e-10);
        }
    }
}

/* Friction is of first order where a coordinate stops or starts: the gap is bounded by ticks in which one
 * does. */
static void test_the_ledger_closes_with_dry_friction_to_first_order(void)
{
    mct_scene cart = scene_with(CART_POLE, MCT_GRAVITY | MCT_VISCOUS | MCT_COULOMB_MOREAU);
    *parameter_of(&cart, "cart_coulomb") = 0.5;
    *parameter_of(&cart, "pole_coulomb") = 0.01;
    mct_scene wheel =
        scene_with(REACTION_WHEEL, MCT_GRAVITY | MCT_VISCOUS | MCT_COULOMB_MOREAU | MCT_MOTOR_QUASI_STATIC);
    *parameter_of(&wheel, "arm_coulomb") = 0.004;
    *parameter_of(&wheel, "wheel_coulomb") = 0.0005;
    const mct_scene *const scenes[] = {&cart, &wheel};
    for (int k = 0; k < 2; k++) {
        const double coarse = gap_of(*scenes[k], 1e-3, true);
        const double fine = gap_of(*scenes[k], 0.125e-3, false);
        printf("; gap %.1e, at an eighth of the tick %.1e\n", coarse, fine);
        TEST_ASSERT_TRUE(coarse < 2e-3);
        TEST_ASSERT_TRUE(fine < coarse / 4);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_works_of_all_effects_add_up_to_the_change_of_energy);
    RUN_TEST(test_the_ledger_closes_with_dry_friction_to_first_order);
    return UNITY_END();
}
