#include "support/swing_up.h"

#include <math.h>
#include <stdio.h>

#include "support/random.h"
#include "support/scenes.h"
#include "unity.h"

#define TWO_DEGREES 0.0349065850398866

mct_scene swing_up_scene(int system)
{
    mct_scene scene;
    mct_scene_defaults(&scene, system);
    scene.stepper = system == CART_POLE ? MCT_STEPPER_RK4 : MCT_STEPPER_EXPO;
    scene.controller = MCT_CONTROLLER_SWING_UP_BALANCE;
    scene.duration = 30;
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_scene_check(&scene, NULL));
    return scene;
}

swing_up run_swing_up(const mct_scene *scene, double duration, double settled)
{
    static mct_loop loop;
    static mct_plan plan; /* large, and no test has threads */
    static mct_sim sim;
    mct_message why = {""};
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, mct_sim_init(&sim, scene, &why), why.text);
    const mct_hal hal = mct_sim_hal(&sim);
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        MCT_OK, mct_loop_init(&loop, &plan, scene, hal, NULL, (mct_samples){NULL, 0}, &why), why.text);
    TEST_ASSERT_EQUAL_INT(MCT_OK, hal.ops->open(hal.context, NULL));
    const int upright = sim.plant.system->actuation->upright_coordinate;
    swing_up result = {.upright_time = INFINITY, .reached_time = INFINITY};
    const long ticks = lround(duration / scene->dt);
    for (long k = 1; k <= ticks; k++) {
        mct_loop_tick(&loop);
        const double time = (double)k * scene->dt;
        const double x = (double)sim.plant.state.x[upright];
        if (angle_size(x) < TWO_DEGREES) {
            result.reached_time = fmin(result.reached_time, time);
            result.upright_time = fmin(result.upright_time, time);
        } else {
            result.upright_time = INFINITY;
        }
        if (time >= settled) {
            result.deviation = fmax(result.deviation, angle_size(x));
        }
        result.farthest = fmax(result.farthest, fabs((double)sim.plant.state.x[0]));
    }
    hal.ops->close(hal.context);
    result.wheel_rate = fabs(mct_plant_value(&sim.plant, 3));
    result.cart_position = fabs(mct_plant_value(&sim.plant, 0));
    result.faults = loop.supervisor.latched;
    return result;
}

void check_variations(int system, bool known)
{
    enum { VARIATIONS = TEST_CASES(500), ALLOWED_TO_FAIL = VARIATIONS / 100 };
    double worst_time = 0;
    double worst_deviation = 0;
    double worst_home = 0;
    double slowest[VARIATIONS];
    int failed = 0;
    for (int seed = 1; seed <= VARIATIONS; seed++) {
        mct_scene scene = swing_up_scene(system);
        scene.noise = 1;
        scene.latency = 1;
        scene.sensor_seed = seed;
        scene.variation_spread = 0.1;
        scene.variation_seed = seed;
        if (known) {
            mct_scene_vary(&scene, &scene);
            scene.variation_spread = 0;
        }
        const swing_up run = run_swing_up(&scene, 40, 20);
        const double home = system == CART_POLE ? run.cart_position : run.wheel_rate;
        const bool good =
            run.upright_time <= 20 && run.faults == 0 && home < (system == CART_POLE ? 0.03 : 20);
        if (!good) {
            failed++;
            printf("  seed %d: upright from %.2f s (first %.2f s), %.3f degrees after 20 s, home %.3g, "
                   "faults %#x\n",
                   seed, run.upright_time, run.reached_time, run.deviation * 57.29578, home,
                   (unsigned)run.faults);
        } else {
            worst_time = fmax(worst_time, run.upright_time);
            worst_deviation = fmax(worst_deviation, run.deviation);
            worst_home = fmax(worst_home, home);
        }
        slowest[seed - 1] = run.upright_time;
    }
    for (int i = 1; i < VARIATIONS; i++) { /* sort */
        for (int k = i; k > 0 && slowest[k] < slowest[k - 1]; k--) {
            const double swap = slowest[k];
            slowest[k] = slowest[k - 1];
            slowest[k - 1] = swap;
        }
    }
    printf("%s, %s to the controller: %d of %d; upright after %.2f s (median), %.2f s (95 %%), %.2f s (worst "
           "good one); then "
           "within %.3f degrees; %s at the end %.3g\n",
           mct_systems[system]->name, known ? "known" : "unknown", VARIATIONS - failed, VARIATIONS,
           slowest[VARIATIONS / 2], slowest[VARIATIONS * 95 / 100], worst_time, worst_deviation * 57.29578,
           system == CART_POLE ? "cart [m]" : "wheel [rad/s]", worst_home);
    TEST_ASSERT_TRUE(failed <= ALLOWED_TO_FAIL);
}
