/*
 * Time scales by trial: a step that follows the motion gives what two steps of half its length give. This knows no
 * scheme's limits and no system's frequencies, so it holds for every kernel, and for the motion's own time scale as well
 * as for that of friction, motor and drag.
 *
 * Under a polynomial of order p an oscillation, exp(i z), becomes larger or smaller, by turns of two orders: it shrinks
 * with 3, 4, 7, 8, 11 and 12 and grows with 1, 2, 5 and 6. So `taylor6` is asked, too, what energy a step brings from
 * nowhere; what the others sum up to costs energy. `seed`, of order 1, is there to show it.
 *
 * The places are those that the energy at the start may reach: each angle goes round while the other coordinates stay,
 * a rotation makes half a turn about each axis, and a system that knows the time goes to the scene's end. What is kinetic
 * there goes into each coordinate in turn as fast as it can, v = M^-1 e sqrt(2 T / (e M^-1 e)), into all together, and
 * into the rates of the start.
 */
#include "pace.h"

#include <string.h>

#include "mctau/constants.h"
#include "mctau/matrix.h"
#include "mctau/plant.h"

enum {
    MOST_RATES = 6,
    ANGLES = 16, /* places round a turn, top and bottom among them */
    BESIDE = 3,  /* places at and beside each of them, where one has little inertia */
    HALVINGS = 40
};

/* Of the error: */
#define FOLLOWED     0.11 /* implicit Euler makes up to 0.1 of a decay, however fast, and does no harm */
#define NOT_FOLLOWED 0.2
#define CONVERGES    0.75 /* between the two half a step must have less of it, a half where it is of order 1 */

#define FEEDS        0.1 /* of a scheme that feeds oscillations, over all steps of the scene */

#define TURN         6.283185307179586476925

typedef struct {
    const mct_scene *scene;
    const mct_system *system;
    mct_kernel kernel;
    uint32_t effects;
    int coordinates, rate, states;
    mct_real input;             /* the largest */
    double energy;              /* at the start [J] */
    bool may_feed;              /* energy that a step brings comes from nowhere, and may add up */
    double gain;                /* largest so far, over what is kinetic */
    double step;                /* [s] */
    mct_constants constants[2]; /* of the step and of its half */
} trial;

/* The largest size of what the scene drives with; not known of a file. */
static double largest_input(const mct_scene *scene, const mct_system *system, uint32_t effects)
{
    double largest = mct_abs(scene->input_value) + mct_abs(scene->input_amplitude);
    if (scene->controller != MCT_CONTROLLER_NONE) {
        largest = mct_max(largest, scene->parameters[system->actuation->supply_parameter]);
    }
    for (int32_t i = 0; i < scene->input_values.count; i++) {
        largest = mct_max(largest, mct_abs(scene->input_values.values[i]));
    }
    if ((effects & MCT_MOTOR) && (effects & MCT_SATURATION_VOLTAGE)) {
        largest = mct_min(largest, scene->parameters[system->actuation->supply_parameter]);
    }
    return largest;
}

static int place_count(const mct_system *system)
{
    int count = system->attitude != MCT_ATTITUDE_NONE ? 4 : system->is_timed ? 2 : 1;
    for (int i = 0; i < system->coordinate_count; i++) {
        count += system->coordinates[i].is_angle ? ANGLES : 0;
    }
    return count;
}

/* State number `place` of those that are tried, at rest; place 0 is the start. */
static void go_to(const trial *self, int place, double beside, mct_state *state, mct_pace *where)
{
    const mct_system *system = self->system;
    double values[MCT_MAX_STATES];
    memcpy(values, self->scene->initial, sizeof values);
    where->coordinate = -1;
    if (system->attitude != MCT_ATTITUDE_NONE && place > 0) { /* q e for e = i, j, k */
        const double *const q = self->scene->initial + self->rate - 4;
        double *const p = values + self->rate - 4;
        const int i = place, j = i % 3 + 1, k = j % 3 + 1;
        p[0] = -q[i];
        p[i] = q[0];
        p[j] = q[k];
        p[k] = -q[j];
    }
    int left = place - 1;
    for (int i = 0; i < system->coordinate_count && left >= 0; i++) {
        if (system->coordinates[i].is_angle) {
            if (left < ANGLES) {
                where->coordinate = i;
                where->angle = values[i] = left * TURN / ANGLES - beside;
            }
            left -= ANGLES;
        }
    }
    for (int i = 0; i < self->coordinates; i++) {
        values[self->rate + i] = 0;
    }
    mct_state_set(system, self->states, values, state);
    if (system->is_timed && place > 0) {
        state->x[self->states] = (mct_real)self->scene->duration;
    }
}

/* v' M v */
static double square_of(const trial *self, const double *M, const double *v)
{
    double sum = 0;
    for (int i = 0; i < self->coordinates; i++) {
        for (int j = 0; j < self->coordinates; j++) {
            sum += v[i] * M[i * self->coordinates + j] * v[j];
        }
    }
    return sum;
}

/* By a step; 0 within rounding, that of the places as well: energies are those of x without its compensation. */
static double energy_gained(const trial *self, const mct_state *start, const mct_state *end)
{
    mct_evaluation a, b;
    self->system->evaluate(&self->constants[0], self->effects, start->x, 0, &a);
    self->system->evaluate(&self->constants[0], self->effects, end->x, 0, &b);
    const double potential = (double)b.potential_energy - (double)a.potential_energy;
    const double gained = potential + ((double)b.kinetic_energy - (double)a.kinetic_energy) +
                          ((double)b.magnetic_energy - (double)a.magnetic_energy);
    double size = (double)a.kinetic_energy + mct_abs((double)a.potential_energy);
    for (int i = 0; i < self->coordinates; i++) {
        size += mct_abs((double)a.tau[i] * (double)start->x[i]);
    }
    return gained > 64 * (double)MCT_REAL_EPSILON * size ? gained : 0;
}

/* What halving a step from a state changes of rates and attitude; of the rates, over what they have or get. */
static double halving(trial *self, const mct_state *start, const double *M, double square)
{
    mct_state whole = *start, halves = *start;
    double v[MOST_RATES], gain[MOST_RATES], turned = 0;
    self->kernel(&self->constants[0], &whole, self->input, 1);
    self->kernel(&self->constants[1], &halves, self->input, 2);
    for (int i = 0; i < self->coordinates; i++) {
        const int at = self->rate + i;
        v[i] = ((double)whole.x[at] - (double)halves.x[at]) + ((double)whole.c[at] - (double)halves.c[at]);
        gain[i] = (double)halves.x[at] - (double)start->x[at];
    }
    for (int i = self->coordinates; i < self->rate;
         i++) { /* a quaternion: all of it moves with its first entry */
        for (int j = self->rate - 4; j < self->rate; j++) {
            const double difference = (double)whole.x[j] - (double)halves.x[j];
            turned += difference * difference;
        }
    }
    if (self->may_feed) {
        self->gain = mct_max(self->gain, energy_gained(self, start, &whole) / (0.5 * square));
    }
    const double scale = mct_max(square, square_of(self, M, gain));
    const double error = mct_sqrt(square_of(self, M, v) / scale);
    const double angle = mct_sqrt(turned);
    return mct_is_finite(error + angle) ? mct_max(error, angle) : DBL_MAX;
}

/* The worst error at a place, for all directions. */
static double error_at(trial *self, int place, double beside, mct_pace *where)
{
    const int n = self->coordinates;
    mct_evaluation e;
    mct_state state;
    double M[MOST_RATES * MOST_RATES], inverse[MOST_RATES * MOST_RATES], a[MOST_RATES], worst = 0;
    go_to(self, place, beside, &state, where);
    self->system->evaluate(&self->constants[0], self->effects, state.x, self->input, &e);
    for (int i = 0; i < n; i++) {
        a[i] = (double)e.acceleration[i] * self->step;
        for (int j = 0; j < n; j++) {
            M[i * n + j] = (double)e.M[i][j];
        }
    }
    if (mct_matrix_inverse(n, M, inverse) != MCT_OK) {
        return 0;
    }
    const double square = mct_max(2 * (self->energy - (double)e.potential_energy), square_of(self, M, a));
    where->share = 1;
    where->lightest = 0;
    for (int i = 0; i < n; i++) {
        const double share = 1 / (M[i * n + i] * inverse[i * n + i]);
        if (share < where->share) {
            where->share = share;
            where->lightest = i;
        }
    }
    if (!(square > 0)) {
        return 0;
    }
    for (int direction = 0; direction <= n + 1; direction++) {
        double v[MOST_RATES];
        for (int i = 0; i < n; i++) {
            v[i] = 0;
            for (int j = 0; j < n; j++) {
                v[i] += direction == j   ? inverse[i * n + j]
                        : direction == n ? inverse[i * n + j] / mct_sqrt(inverse[j * n + j])
                                         : 0;
            }
            v[i] = direction == n + 1 ? self->scene->initial[self->rate + i] : v[i];
        }
        const double size = square_of(self, M, v);
        if (!(size > 0)) {
            continue;
        }
        for (int i = 0; i < n; i++) {
            const double rate = v[i] * mct_sqrt(square / size);
            state.x[self->rate + i] = (mct_real)rate;
            state.c[self->rate + i] = (mct_real)(rate - (double)state.x[self->rate + i]);
        }
        const double error = halving(self, &state, M, square);
        worst = mct_max(worst, error);
    }
    return worst;
}

static double highest_potential(const trial *self)
{
    double highest = -DBL_MAX;
    for (int place = 0; place < place_count(self->system); place++) {
        mct_evaluation e;
        mct_state state;
        mct_pace where;
        go_to(self, place, 0, &state, &where);
        self->system->evaluate(&self->constants[0], self->effects, state.x, 0, &e);
        highest = mct_max(highest, (double)e.potential_energy);
    }
    return highest;
}

static double worst_error(trial *self, mct_pace *pace)
{
    double worst = 0;
    for (int place = 0; place < place_count(self->system); place++) {
        mct_pace where = *pace;
        double width = 0; /* within which the inertia is little: share + angle^2 */
        for (int k = 0; k < (width > 0 ? BESIDE : 1); k++) {
            const double error = error_at(self, place, k * width, &where);
            if (k == 0 && where.coordinate >= 0 && where.share < MCT_SMALL_SHARE) {
                width = mct_sqrt(where.share);
            }
            if (error > worst) {
                worst = error;
                *pace = where;
            }
        }
    }
    return worst;
}

void mct_pace_find(const mct_scene *scene, mct_pace *pace)
{
    trial self;
    mct_evaluation e;
    mct_state start;
    memset(pace, 0, sizeof *pace);
    memset(&self, 0, sizeof self);
    self.scene = scene;
    self.system = mct_systems[scene->system];
    self.effects = mct_scene_effects(scene);
    self.step = pace->longest = mct_scene_step(scene);
    if (self.system->is_process) {
        return;
    }
    /* Dry friction is an impulse that no step is too long for. A series may need it, where it finds the kinks of drag. */
    const uint32_t effects = self.effects & MCT_KERNEL_EFFECTS;
    const mct_named_kernel *kernel = self.system->kernel(scene->stepper, effects & ~(uint32_t)MCT_COULOMB);
    if (kernel == NULL) {
        kernel = self.system->kernel(scene->stepper, effects);
    }
    self.kernel = kernel->function;
    self.coordinates = mct_coordinate_count(scene);
    self.rate = mct_rate_index(self.system);
    self.states = mct_state_count(scene);
    self.input = (mct_real)largest_input(scene, self.system, self.effects);
    mct_state_set(self.system, self.states, scene->initial, &start);
    (void)self.system->prepare(scene, self.step, &self.constants[0], NULL);
    self.system->evaluate(&self.constants[0], self.effects, start.x, 0, &e);
    self.energy = (double)e.kinetic_energy + (double)e.potential_energy;
    if (self.input > 0 || (self.effects & MCT_CLOCK)) { /* it may be driven to the top */
        self.energy = mct_max(self.energy, highest_potential(&self));
    }
    self.may_feed = scene->stepper == MCT_STEPPER_TAYLOR6 && self.input == 0 && !(self.effects & MCT_SOURCES);
    double first = 0;
    for (int halvings = 0; halvings < HALVINGS; halvings++) {
        mct_pace at = *pace;
        const bool is_fit = self.system->prepare(scene, self.step / 2, &self.constants[1], NULL) == MCT_OK;
        self.gain = 0;
        const double error = is_fit ? worst_error(&self, &at) : DBL_MAX;
        const bool feeds = self.gain * scene->duration > FEEDS * self.step;
        if (halvings == 0) {
            *pace = at;
            pace->error = first = error;
            pace->verdict = feeds || error > NOT_FOLLOWED ? MCT_PACE_NOT_FOLLOWED
                            : error > FOLLOWED            ? MCT_PACE_LONG
                                                          : MCT_PACE_FOLLOWS;
        } else if (halvings == 1 && error > CONVERGES * first) {
            pace->verdict = MCT_PACE_NOT_FOLLOWED;
        }
        if (feeds || error > FOLLOWED) {
            pace->longest = 0;
        } else if (halvings == 0 || pace->longest > 0) {
            return;
        } else {
            pace->longest = self.step; /* if one of half its length follows, too, and this was no chance */
        }
        self.step /= 2;
        self.constants[0] = self.constants[1];
    }
}
