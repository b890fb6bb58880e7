/*
 * Writes the motions that tools/bench measures errors by: for each scene its samples, "NAME: x0 x1 ...", each
 * on a line; and on standard error how far a second computation is from it. Both in quadruple precision, rounded to
 * double.
 *
 * The closed form, extrapolated to order 18 (tests/support/quad.h), beside itself with half the step. The wheel by
 * variation of constants from equations in raw form (tests/support/reference.h), over the first sample beside the
 * extrapolated closed form; without inductance these equations extrapolated, beside themselves with half the step.
 */
#include <math.h>
#include <stdio.h>

#include "scenes.h"
#include "support/quad.h"
#include "wheel_reference.h"

#define FORM_REAL  quad
#define FORM_SIN   quad_sin
#define FORM_COS   quad_cos
#define FORM_SQRT  quad_sqrt
#define FORM(name) exact_##name
#include "closed_form.h"

typedef struct {
    quad k[SCENE_CONSTANTS];
    quad input;
} exact_model;

#define EXACT_RATE(name)                                                                                  \
    static void name##_rate(const void *model, quad time, const quad *x, quad *dx)                        \
    {                                                                                                     \
        (void)time;                                                                                       \
        exact_##name##_rate(((const exact_model *)model)->k, ((const exact_model *)model)->input, x, dx); \
    }
EXACT_RATE(pendulum)
EXACT_RATE(spring)
EXACT_RATE(cart_pole)
EXACT_RATE(wheel)
EXACT_RATE(body)

static const struct {
    void (*constants)(const double *p, quad *k);
    quad_rate rate;
} forms[] = {
    [SCENE_PENDULUM] = {exact_pendulum_constants, pendulum_rate},
    [SCENE_SPRING] = {exact_spring_constants, spring_rate},
    [SCENE_CART_POLE] = {exact_cart_pole_constants, cart_pole_rate},
    [SCENE_WHEEL] = {exact_wheel_constants, wheel_rate},
    [SCENE_BODY] = {exact_body_constants, body_rate},
};

/* Steps in a tick: a stiff motor's are as long as its time constant. */
static int steps_of(const bench_scene *scene)
{
    const double time_constant =
        scene->form == SCENE_WHEEL ? scene->parameters[11].value / scene->parameters[10].value : SCENE_TICK;
    return (int)ceil(SCENE_TICK / time_constant);
}

/* In `refined` times as many steps, up to some sample. */
static void extrapolate(const bench_scene *scene, int refined, int last, double *samples)
{
    const double *inputs = scene_inputs(scene);
    exact_model model;
    double p[SCENE_PARAMETERS];
    quad x[SCENE_STATES] = {0};
    scene_parameters(scene, p);
    forms[scene->form].constants(p, model.k);
    for (int i = 0; i < scene->states; i++) {
        x[i] = scene->start[i];
    }
    for (int tick = 0; tick < last * SCENE_TICKS_PER_SAMPLE; tick++) {
        model.input = inputs[tick];
        quad_extrapolate(forms[scene->form].rate, &model, 0, x, scene->states, (quad)SCENE_TICK,
                         (long)refined * steps_of(scene));
        for (int i = 0; (tick + 1) % SCENE_TICKS_PER_SAMPLE == 0 && i < SCENE_STATES; i++) {
            samples[tick / SCENE_TICKS_PER_SAMPLE * SCENE_STATES + i] = (double)x[i];
        }
    }
}

int main(void)
{
    /* Without quadruple precision (clang) roundings of long double are left. */
    const double allowed = (quad)1 + (quad)1e-30 != 1 ? 1e-14 : 1e-12;
    for (int n = 0; n < SCENE_COUNT; n++) {
        const bench_scene *scene = &bench_scenes[n];
        static double samples[SCENE_SAMPLES * SCENE_STATES], others[SCENE_SAMPLES * SCENE_STATES];
        const bool is_wheel = scene->form == SCENE_WHEEL;
        const bool has_form =
            !(is_wheel && scene->parameters[11].value == 0); /* which divides by the inductance */
        const int compared = is_wheel && has_form ? 1 : SCENE_SAMPLES;
        double difference = 0;
        memset(samples, 0, sizeof samples);
        memset(others, 0, sizeof others);
        if (is_wheel &&
            !(wheel_reference(scene, 1, samples) && (has_form || wheel_reference(scene, 2, others)))) {
            fprintf(stderr, "%s: no reference\n", scene->name);
            return 1;
        }
        if (!is_wheel) {
            extrapolate(scene, 1, SCENE_SAMPLES, samples);
        }
        if (has_form) {
            extrapolate(scene, 2, compared, others);
        }
        for (int i = 0; i < compared * SCENE_STATES; i++) {
            difference = fmax(difference, fabs(others[i] - samples[i]) / fmax(1, fabs(samples[i])));
        }
        fprintf(stderr, "%s: %s differs by %.1e\n", scene->name,
                is_wheel && has_form ? "extrapolation, 0.2 s," : "half the step", difference);
        if (!(difference < allowed)) {
            return 1;
        }
        for (int row = 0; row < SCENE_SAMPLES; row++) {
            printf("%s:", scene->name);
            for (int i = 0; i < SCENE_STATES; i++) {
                printf(" %.17g", samples[row * SCENE_STATES + i]);
            }
            printf("\n");
        }
    }
    return 0;
}
