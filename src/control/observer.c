#include "mctau/observer.h"

#include <string.h>

#include "mctau/matrix.h"
#include "mctau/sincos.h"

#define PI   3.141592653589793238463
#define TURN (2 * PI)

enum {
    LONG_GAP = 5, /* ticks: by then the voltage is zero */
    LAP = 1 << 30
};

/* Within +-pi, from within +-(2 pi + pi). */
static mct_real wrapped(mct_real angle)
{
    const mct_real turns = angle > MCT_R(3 * PI) ? MCT_R(2 * TURN) : angle > MCT_R(PI) ? MCT_R(TURN) : 0;
    const mct_real back = angle < MCT_R(-3 * PI) ? MCT_R(2 * TURN) : angle < MCT_R(-PI) ? MCT_R(TURN) : 0;
    return angle - turns + back;
}

/* What follows from the estimated positions. */
static void take_sine(mct_observer *observer)
{
    const mct_real upright = observer->x[observer->system->actuation->upright_coordinate];
    mct_sincos(upright, &observer->sine, &observer->cosine);
}

void mct_observer_init(mct_observer *observer, const mct_scene *scene, const mct_constants *constants)
{
    const mct_system *system = mct_systems[scene->system];
    memset(observer, 0, sizeof *observer);
    observer->system = system;
    observer->constants = constants;
    observer->effects = mct_scene_effects(scene);
    observer->counter_shift = (uint32_t)(32 - scene->counter_bits);
    observer->h = (mct_real)scene->dt;
    const double exponent = -scene->observer_bandwidth * scene->dt;
    double pole_less_one = -1; /* a bandwidth beyond expm1's reach forgets at once */
    if (mct_expm1(1, &exponent, &pole_less_one) != MCT_OK) {
        pole_less_one = -1;
    }
    observer->keep = (mct_real)((1 + pole_less_one) * (1 + pole_less_one));
    observer->rate_gain = (mct_real)(pole_less_one * pole_less_one / scene->dt);
    for (int i = 0; i < system->coordinate_count; i++) {
        mct_encoder_track *track = &observer->encoders[i];
        const bool angle = system->coordinates[i].is_angle;
        const double counts = scene->counts_per_unit[i];
        track->turn = angle ? (int32_t)(counts + 0.5) : 0;
        track->unit = (mct_real)(angle ? TURN / track->turn : 1 / counts);
        double start = scene->initial[i];
        if (angle) {
            start -= TURN * (double)(int32_t)(start / TURN);
        }
        track->start = (mct_real)start;
        observer->x[i] = angle ? wrapped((mct_real)start) : (mct_real)start;
    }
    take_sine(observer);
}

void mct_observer_restart(mct_observer *observer)
{
    observer->started = false;
    for (int i = 0; i < observer->system->coordinate_count; i++) {
        mct_encoder_track *track = &observer->encoders[i];
        track->travelled = track->laps = 0;
        track->deviation = 0;
        observer->x[i] = track->turn != 0 ? wrapped(track->start) : track->start;
        observer->x[observer->system->coordinate_count + i] = 0;
    }
    take_sine(observer);
}

/* Counts moved since the last tick, modulo the counter's range. */
static int32_t counts_moved(const mct_encoder_track *track, int32_t counts, uint32_t shift)
{
    const uint32_t difference = ((uint32_t)counts - (uint32_t)track->last) << shift;
    int32_t moved;
    memcpy(&moved, &difference, sizeof moved);
    return shift == 0 ? moved : moved / (int32_t)(1u << shift); /* exact: the low bits are zero */
}

/* No sum leaves 32 bits: a turn or lap is 2^30 counts at most. */
static void travel(mct_encoder_track *track, int32_t moved)
{
    const int32_t lap = track->turn != 0 ? track->turn : LAP;
    const int32_t sum = track->travelled + moved % lap;
    track->travelled = sum % lap;
    if (track->turn == 0) {
        track->laps += moved / lap + sum / lap;
    }
}

void mct_observer_update(mct_observer *observer, const mct_reading *reading, mct_real input)
{
    const int n = observer->system->coordinate_count;
    const mct_real h = observer->h;
    const bool valid = (reading->flags & MCT_READING_NO_COUNTS) == 0;
    if (!observer->started) {
        if (valid) {
            for (int i = 0; i < n; i++) {
                observer->encoders[i].last = reading->counts[i];
            }
            observer->started = true;
        }
        return;
    }
    /* After a gap the count tells where it is, but not how fast it got there: no velocity comes of it. */
    const bool is_back = valid && observer->blind_ticks >= LONG_GAP;
    observer->blind_ticks = valid ? 0 : observer->blind_ticks + 1;
    mct_real a[MCT_MAX_ENCODERS];
    observer->system->actuation->accelerate(observer->constants, observer->effects, observer->x,
                                            observer->sine, observer->cosine, input, a);
    if (observer->gravity_slope > 0) {
        const int upright = observer->system->actuation->upright_coordinate;
        observer->gravity = observer->gravity_slope * observer->sine;
        a[upright] += observer->excess * observer->gravity;
    }
    for (int i = 0; i < n; i++) {
        mct_encoder_track *track = &observer->encoders[i];
        mct_real *rate = &observer->x[n + i];
        const mct_real model_moved = h * *rate + MCT_R(0.5) * h * h * a[i];
        *rate += h * a[i];
        if (!valid) {
            track->deviation -= model_moved; /* the count stood still: the model goes on alone */
            observer->correction[i] = 0;
        } else {
            const int32_t moved = counts_moved(track, reading->counts[i], observer->counter_shift);
            track->last = reading->counts[i];
            travel(track, moved);
            const mct_real deviation =
                is_back ? 0 : track->deviation + ((mct_real)moved * track->unit - model_moved);
            track->deviation = observer->keep * deviation;
            *rate += observer->rate_gain * deviation;
            observer->correction[i] = observer->rate_gain * deviation / h;
        }
        track->deviation = mct_settled(track->deviation);
        *rate = mct_settled(*rate);
        const mct_real counts = (mct_real)track->laps * MCT_R(LAP) + (mct_real)track->travelled;
        const mct_real measured = track->start + counts * track->unit;
        const mct_real position = measured - track->deviation;
        observer->x[i] = track->turn != 0 ? wrapped(position) : position;
    }
    take_sine(observer);
}
