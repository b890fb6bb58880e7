#include "mctau/observer.h"

#include <string.h>

#include "mctau/matrix.h"
#include "mctau/sincos.h"

#define PI   3.141592653589793238463
#define TURN (2 * PI)

enum {
    LONG_GAP = 5, /* ticks: by then the voltage is zero */
    LAP = 1 << 30 /* counts of a length */
};

/* Within +-pi, from within +-(2 pi + pi). */
static mct_real wrapped(mct_real angle)
{
    const mct_real size = mct_size(angle);
    if (size <= MCT_R(PI)) {
        return angle;
    }
    const mct_real turns = size > MCT_R(3 * PI) ? MCT_R(2 * TURN) : MCT_R(TURN);
    return angle > 0 ? angle - turns : angle + turns;
}

/* What follows from the estimated positions. */
MCT_INLINE void take_sine(mct_observer *observer)
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
        track->lap = angle ? track->turn : LAP;
        track->lap_moves = angle ? 0 : (mct_real)LAP;
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

/* No sum leaves 32 bits: a lap is 2^30 counts at most. */
static void travel(mct_encoder_track *track, int32_t moved)
{
    const int32_t lap = track->lap;
    const int32_t sum = track->travelled + moved % lap;
    track->travelled = sum % lap;
    track->laps = (int32_t)((uint32_t)track->laps + (uint32_t)(moved / lap + sum / lap));
}

/* What has decayed to next to nothing comes to rest. As a product in range nearly always tells, both are in range. */
static void settle(mct_real *rate, mct_real *deviation)
{
    if (!(mct_size(*rate * *deviation) >= MCT_REAL_NOTHING)) {
        *rate = mct_settled(*rate);
        *deviation = mct_settled(*deviation);
    }
}

void mct_observer_update(mct_observer *observer, const mct_reading *reading, mct_real input)
{
    enum { N = MCT_MAX_ENCODERS }; /* coordinates of a system with a motor */
    const mct_real h = observer->h;
    const bool valid = (reading->flags & MCT_READING_NO_COUNTS) == 0;
    if (!observer->started) {
        if (valid) {
            for (int i = 0; i < N; i++) {
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
    MCT_UNROLL
    for (int i = 0; i < N; i++) {
        mct_encoder_track *track = &observer->encoders[i];
        const mct_real model_moved = h * observer->x[N + i] + MCT_R(0.5) * h * h * a[i];
        mct_real rate = observer->x[N + i] + h * a[i];
        mct_real deviation =
            track->deviation - model_moved; /* when the count stood still: the model goes on alone */
        observer->correction[i] = 0;
        if (valid) {
            const int32_t moved = counts_moved(track, reading->counts[i], observer->counter_shift);
            track->last = reading->counts[i];
            travel(track, moved);
            const mct_real missed =
                is_back ? 0 : track->deviation + ((mct_real)moved * track->unit - model_moved);
            deviation = observer->keep * missed;
            rate += observer->rate_gain * missed;
            observer->correction[i] = observer->rate_gain * missed;
        }
        settle(&rate, &deviation);
        track->deviation = deviation;
        observer->x[N + i] = rate;
        const mct_real counts = (mct_real)track->laps * track->lap_moves + (mct_real)track->travelled;
        const mct_real measured = track->start + counts * track->unit;
        const mct_real position = measured - deviation;
        observer->x[i] = track->turn != 0 ? wrapped(position) : position;
    }
    take_sine(observer);
}
