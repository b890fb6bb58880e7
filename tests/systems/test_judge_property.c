/*
 * Every system before the generic Gauss engine, as `mctau mct` shows it: random states, parameters, lists and effects,
 * all drawn by the descriptors, so that a new system is judged as soon as it is listed.
 *
 * The engine gets the geometry, the masses and the forces f that the closed form names. That these are the right forces
 * is for each system's own test.
 *
 * Tolerances: 1e-12 in double, 300 roundings in float, relative to the size of the terms that meet in a result: by
 * Cauchy-Schwarz a force on coordinate j is at most sqrt(M_jj) times the norm, weighted by mass, of what acts and
 * accelerates, and C v beside it (in a turning frame it is large where nothing accelerates); an acceleration inherits
 * |M^-1| times that, and a constraint force the acceleration's.
 */
#include <math.h>
#include <stdio.h>

#include "mctau/judge.h"
#include "mctau/matrix.h"
#include "support/draws.h"
#include "support/scenes.h"
#include "unity.h"

enum { TRIALS = TEST_CASES(10000) };

#define TOLERANCE (MCT_REAL_IS_FLOAT ? 300 * (double)FLT_EPSILON : 1e-12)
#define APPARENT \
    (MCT_CENTRIFUGAL | MCT_CORIOLIS | MCT_EULER_FORCE) /* without them it is not the true motion */

void setUp(void)
{
}

void tearDown(void)
{
}

static mct_scene scene;
static mct_constants constants;
static mct_real x[MCT_MAX_STATES + 1];
static mct_evaluation out;
static mct_judgement judgement;
static double worst_acceleration, worst_force, worst_work;

/* Gives false where the scene is refused: a body without inertia about an axis. */
static bool draw(test_random *random, int number)
{
    const mct_system *system = mct_systems[number];
    if (!draw_scene(random, number, APPARENT, &scene, &constants, x)) {
        return false;
    }
    if (system->is_timed) {
        x[mct_state_count(&scene)] =
            (mct_real)random_in(random, 0, 0.3); /* the engine's rounding grows with turns */
    }
    const mct_real input = system->input_without_motor != NULL ? (mct_real)random_in(random, -10, 10) : 0;
    system->evaluate(&constants, mct_scene_effects(&scene), x, input, &out);
    return true;
}

static double norm_of_forces(void)
{
    double square = 0;
    for (int i = 0; i < judgement.particle_count; i++) {
        for (int k = 0; k < 3; k++) {
            const double f = (double)out.force[judgement.particle[i]][k];
            const double mass = (double)judgement.mass[i];
            square += mass * pow((double)judgement.motion.particle_acceleration[i][k], 2) + f * f / mass;
        }
    }
    return sqrt(square);
}

static void expect(const char *what, double closed, double engine, double size, double *worst)
{
    const double error = fabs(closed - engine) / (size > 0 ? size : 1);
    *worst = fmax(*worst, error);
    /* In a turning frame the engine differentiates a rotation twice by time: its terms are larger than what is left. */
    const double tolerance = mct_systems[scene.system]->is_timed ? 10 * TOLERANCE : TOLERANCE;
    if (!(error <= tolerance)) {
        char text[200];
        snprintf(text, sizeof text, "%s: %s: closed form %.17g, engine %.17g, terms of size %.3g",
                 mct_systems[scene.system]->name, what, closed, engine, size);
        TEST_FAIL_MESSAGE(text);
    }
}

static void compare(const mct_system *system)
{
    const mct_gauss_motion *motion = &judgement.motion;
    const int n = system->coordinate_count;
    const mct_real *v = x + mct_rate_index(system);
    double M[MCT_MAX_COORDINATES * MCT_MAX_COORDINATES], inverse[MCT_MAX_COORDINATES * MCT_MAX_COORDINATES];
    double force_size[MCT_MAX_COORDINATES], acceleration_size[MCT_MAX_COORDINATES] = {0};
    const double norm = norm_of_forces();
    for (int i = 0; i < n; i++) {
        force_size[i] = fabs((double)judgement.couple[i]) + fabs((double)motion->Cv[i]);
        for (int j = 0; j < n; j++) {
            M[i * n + j] = (double)motion->M[i][j];
        }
        force_size[i] += sqrt(M[i * n + i]) * norm;
    }
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_matrix_inverse(n, M, inverse));
    double work = 0, work_size = 0;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            acceleration_size[i] += fabs(inverse[i * n + j]) * force_size[j];
            expect("M", (double)out.M[i][j], M[i * n + j], sqrt(M[i * n + i] * M[j * n + j]),
                   &worst_acceleration);
        }
        expect("C v", (double)out.Cv[i], (double)motion->Cv[i], force_size[i], &worst_acceleration);
        expect("acceleration", (double)out.acceleration[i], (double)motion->acceleration[i],
               acceleration_size[i], &worst_acceleration);
        double by_christoffel = 0;
        for (int j = 0; j < n; j++) {
            by_christoffel += (double)judgement.lagrange.C_alternative[i][j] * (double)v[j];
        }
        if (system->attitude == MCT_ATTITUDE_NONE && !system->is_timed &&
            !(mct_scene_effects(&scene) & MCT_CLOCK)) {
            expect("C v of eq. 229", by_christoffel, (double)motion->Cv[i], force_size[i],
                   &worst_acceleration);
        }
        work -= (double)judgement.couple[i] * (double)v[i];
        work_size += force_size[i] * fabs((double)v[i]);
    }
    for (int i = 0; i < judgement.particle_count; i++) {
        const int own = judgement.particle[i];
        double size = sqrt((double)judgement.mass[i]) * norm;
        for (int j = 0; j < n; j++) {
            size += sqrt((double)judgement.mass[i] * M[j * n + j]) * acceleration_size[j];
        }
        for (int k = 0; k < 3; k++) {
            const double e = (double)out.constraint_force[own][k];
            expect("constraint force", e, (double)motion->constraint_force[i][k], size, &worst_force);
            work += e * (double)motion->velocity[i][k];
            work_size += size * fabs((double)motion->velocity[i][k]);
        }
    }
    const mct_real *const power = out.power;
    const double prescribed = (double)(power[MCT_EFFECT_BASE_MOTION] + power[MCT_EFFECT_CENTRIFUGAL] +
                                       power[MCT_EFFECT_EULER] + out.power_frame);
    expect("work of the constraints but for couples and base", work, prescribed, work_size, &worst_work);
}

static void test_every_systems_closed_form_is_what_gauss_principle_gives(void)
{
    for (int number = 0; number < MCT_SYSTEM_COUNT; number++) {
        const mct_system *system = mct_systems[number];
        test_random random = {(uint64_t)number + 1};
        int judged = 0, refused = 0, singular = 0;
        worst_acceleration = worst_force = worst_work = 0;
        for (int trial = 0; trial < 3 * TRIALS && judged < TRIALS && !system->is_process; trial++) {
            if (!draw(&random, number)) {
                refused++;
                continue;
            }
            const mct_status status =
                mct_judge(system, &constants, mct_particle_count(&scene), x, &out, &judgement);
            singular += status == MCT_ERROR_SINGULAR ? 1 : 0;
            if (status != MCT_ERROR_SINGULAR) {
                TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, status, system->name);
                compare(system);
                judged++;
            }
        }
        printf("%-18s acceleration %.1e, constraint force %.1e, work %.1e; refused %d, singular %d\n",
               system->name, worst_acceleration, worst_force, worst_work, refused, singular);
        TEST_ASSERT_TRUE_MESSAGE(judged == TRIALS || system->is_process, system->name);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_systems_closed_form_is_what_gauss_principle_gives);
    return UNITY_END();
}
