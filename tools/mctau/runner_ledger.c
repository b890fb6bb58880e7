/*
 * The ledger of a run. Each tick starts where the plant is and follows the motion that the equation has there, until
 * it is exact to rounding; the works of that motion are the effects'. Where the plant's stepper ends instead is the
 * stepper's own doing.
 *
 * Method       the equation of mct_system.evaluate with the powers as further states, so that works and energies are of
 *              one motion; the modified midpoint rule, extrapolated (W. B. Gragg 1965; E. Hairer, S. P. Norsett,
 *              G. Wanner, Solving ordinary differential equations I, II.9), to order 2 ROWS at most. A part of a tick is
 *              taken when the works stand still and the kinetic energy gains their sum, both to rounding, and
 *              halved otherwise: so steps follow the fastest time scale, a stiff motor's too, and a kink (drag
 *              that turns round, the start or stop of dry friction) is closed in until what it spoils is below rounding.
 * Dry friction A coordinate whose sliding speed changes sign in the smallest part stops there. At rest it stays while
 *              evaluate() says that friction holds it, to within HELD of its size.
 * Cost         some 20 to 200 evaluations a tick, 3000 where a body stops or starts.
 */
#include "runner_ledger.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mctau/constants.h"
#include "mctau/rotation.h"
#include "mctau/stepper.h"
#include "mctau/system.h"
#include "runner_run.h"
#include "say.h"

enum {
    ROWS = 8,                                      /* of the extrapolation */
    LARGEST = RUNNER_MAX_STATES + 1 + POWER_COUNT, /* states, time, works */
    HALVINGS = 44,                                 /* of a tick, at most */
    MOST_LOST = 20,   /* ticks, after which the rest of the run is not followed */
    MOST_PARTS = 5000 /* tried a tick */
};
#define PI            3.14159265358979323846
#define BELT_ROUNDING (64 * (double)MCT_REAL_EPSILON) /* of its speed: what is as near rests on it */
#define STRICT \
    0.05 /* parts of a tick longer than that are taken when they close to a thousandth of the run's rounding */
#define HELD 1e-7 /* of a friction's size: an acceleration below is rounding */

typedef double vector[LARGEST];

/* A sum that keeps what rounding drops. */
typedef struct {
    double sum, rest;
} account;

typedef struct {
    account kinetic, potential, magnetic;
} accounts;

/* Where the motion is. */
typedef struct {
    vector value, rest; /* of the states; their sum is exact */
    vector rate;        /* there; behind the states the powers */
    energies energy;
    bool rests[RUNNER_MAX_COORDINATES];   /* against dry friction */
    double least[RUNNER_MAX_COORDINATES]; /* acceleration of what rests that is more than rounding */
} place;

struct ledger {
    const mct_system *system;
    uint32_t effects;
    mct_constants constants;
    int coordinates, first_rate, states, entries; /* entries: the time, too */
    double dt, belt_speed, phase_rate[MCT_PHASES];
    double input;
    /* the run */
    uint64_t calls, lost_ticks;
    place here;
    energies start;
    account work[POWER_COUNT];
    accounts of_stepper, unexplained;
    double works, largest; /* sum of sizes of all works, and largest energy [J] */
};

/* --- sums --- */

static void add(account *self, double amount)
{
    const double sum = self->sum + amount;
    self->rest += fabs(self->sum) >= fabs(amount) ? (self->sum - sum) + amount : (amount - sum) + self->sum;
    self->sum = sum;
}

static double value_of(account self)
{
    return self.sum + self.rest;
}

static energies less(energies a, energies b)
{
    return (energies){a.kinetic - b.kinetic, a.potential - b.potential, a.magnetic - b.magnetic};
}

static void add_energies(accounts *self, energies amount)
{
    add(&self->kinetic, amount.kinetic);
    add(&self->potential, amount.potential);
    add(&self->magnetic, amount.magnetic);
}

static energies values_of(const accounts *self)
{
    return (energies){value_of(self->kinetic), value_of(self->potential), value_of(self->magnetic)};
}

/* --- the equation --- */

static void evaluate(const ledger *self, const double *y, mct_evaluation *at)
{
    mct_real x[RUNNER_MAX_STATES];
    for (int i = 0; i < self->entries; i++) {
        x[i] = (mct_real)y[i];
    }
    self->system->evaluate(&self->constants, self->effects, x, (mct_real)self->input, at);
}

static void turn_rate(const mct_system *system, const double *attitude, const double *spin, double *rate)
{
    mct_real q[4], w[3], out[4];
    for (int i = 0; i < 4; i++) {
        q[i] = (mct_real)attitude[i];
        w[i % 3] = (mct_real)spin[i % 3];
    }
    if (system->attitude == MCT_ATTITUDE_BODY) {
        mct_quaternion_rate_body(q, w, out);
    } else {
        mct_quaternion_rate_space(q, w, out);
    }
    for (int i = 0; i < 4; i++) {
        rate[i] = (double)out[i];
    }
}

static bool is_held(const place *from, const mct_evaluation *at, int i)
{
    return from->rests[i] && fabs((double)at->acceleration[i]) <= from->least[i];
}

/* Rates of all states, and the powers behind them. */
static void rates_of(const ledger *self, const place *from, const double *y, const mct_evaluation *at,
                     double *rate)
{
    const int n = self->coordinates;
    const int first = self->first_rate;
    const int positions = self->system->attitude == MCT_ATTITUDE_NONE ? n : n - 3;
    const powers power = runner_powers(at);
    for (int i = 0; i < n; i++) {
        rate[first + i] = is_held(from, at, i) ? 0 : (double)at->acceleration[i];
    }
    for (int i = 0; i < positions; i++) {
        rate[i] = y[first + i];
    }
    if (positions < n) {
        turn_rate(self->system, y + positions, y + first + positions, rate + positions);
    }
    if (self->effects & MCT_MOTOR_INDUCTIVE) {
        const mct_actuation *const actuation = self->system->actuation;
        const mct_motor *const motor = actuation->motor(&self->constants);
        const double emf = (double)motor->emf * y[first + actuation->driven_coordinate];
        rate[first + n] = (self->input - (double)motor->resistance * y[first + n] - emf) *
                          (double)motor->inverse_inductance;
    }
    for (int i = first + n; i < self->states && self->system->phases != NULL; i++) {
        rate[i] = self->phase_rate[i - first - n];
    }
    if (self->entries > self->states) {
        rate[self->states] = 1;
    }
    memcpy(rate + self->entries, &power, sizeof power);
}

/* Sliding speed of a coordinate. */
static double slip(const ledger *self, const double *y, int i)
{
    return y[self->first_rate + i] - self->belt_speed;
}

/* Which coordinates rest: those without a sliding speed that dry friction holds. */
static void find_rests(const ledger *self, const mct_evaluation *at, place *here)
{
    for (int i = 0; i < self->coordinates; i++) {
        here->rests[i] = (self->effects & MCT_COULOMB) != 0 && slip(self, here->value, i) == 0;
        if (here->rests[i]) {
            mct_evaluation forth, back;
            vector y;
            const double nudge = 1e-6 * (1 + fabs(self->belt_speed));
            memcpy(y, here->value, sizeof y);
            y[self->first_rate + i] += nudge;
            evaluate(self, y, &forth);
            y[self->first_rate + i] -= 2 * nudge;
            evaluate(self, y, &back);
            here->least[i] = HELD * fabs((double)back.acceleration[i] - (double)forth.acceleration[i]);
            here->rests[i] = is_held(here, at, i);
        }
    }
}

/* Energies and rates where the motion has come to; larger energies make rounding larger. */
static void arrive(ledger *self, place *here)
{
    mct_evaluation at;
    for (int i = 0; i < self->coordinates && self->belt_speed != 0; i++) {
        if (fabs(slip(self, here->value, i)) <= BELT_ROUNDING * fabs(self->belt_speed)) {
            here->value[self->first_rate + i] = self->belt_speed;
            here->rest[self->first_rate + i] = 0;
        }
    }
    evaluate(self, here->value, &at);
    here->energy = runner_energies(&at);
    find_rests(self, &at, here);
    rates_of(self, here, here->value, &at, here->rate);
}

static double size_of(const ledger *self)
{
    return self->works + self->largest;
}

/* --- the motion --- */

/* Whether coordinate i slides the other way than from where the part began. */
static bool turns_round(const ledger *self, const place *from, const double *y, int i)
{
    const double before = slip(self, from->value, i);
    const double sense = before != 0 ? before : from->rate[self->first_rate + i];
    return (self->effects & MCT_COULOMB) != 0 && sense * slip(self, y, i) < 0;
}

/* Whether the first coordinate is a distance from a pivot, which what passes there leaves on the other side. */
static bool is_distance(const ledger *self)
{
    return self->system->coordinates[0].position.minimum > 0;
}

/* Whether forces are still those of where the part began: no sliding has turned round, no rest has ended, no pivot is
 * passed. */
static bool is_smooth(const ledger *self, const place *from, const double *y, const double *rate)
{
    if (is_distance(self) && y[0] <= 0) {
        return false;
    }
    for (int i = 0; i < self->coordinates; i++) {
        if (turns_round(self, from, y, i) || (from->rests[i] && rate[self->first_rate + i] != 0)) {
            return false;
        }
    }
    return true;
}

/* Changes after h by `steps` steps of the modified midpoint rule; whether dry friction kept its sense. */
static bool midpoint(const ledger *self, const place *from, double h, int steps, double *change)
{
    const int all = self->entries + POWER_COUNT;
    const double step = h / steps;
    vector before = {0}, now, y, rate;
    bool smooth = true;
    for (int i = 0; i < all; i++) {
        now[i] = step * from->rate[i];
    }
    for (int k = 1; k < steps; k++) {
        mct_evaluation at;
        for (int i = 0; i < self->entries; i++) {
            y[i] = from->value[i] + (from->rest[i] + now[i]);
        }
        evaluate(self, y, &at);
        rates_of(self, from, y, &at, rate);
        smooth = smooth && is_smooth(self, from, y, rate);
        for (int i = 0; i < all; i++) {
            const double next = before[i] + 2 * step * rate[i];
            before[i] = now[i];
            now[i] = next;
        }
    }
    memcpy(change, now, sizeof now);
    return smooth;
}

/* Goes on by a change of the states. */
static void move(ledger *self, const place *from, const double *change, place *to)
{
    for (int i = 0; i < self->entries; i++) {
        const double sum = from->value[i] + change[i];
        const double added = sum - from->value[i];
        const double dropped = (from->value[i] - (sum - added)) + (change[i] - added);
        to->rest[i] = 0;
        to->value[i] = sum;
        const double rest = from->rest[i] + dropped;
        to->value[i] = sum + rest;
        to->rest[i] = rest - (to->value[i] - sum);
    }
    arrive(self, to);
}

static powers works_of(const ledger *self, const double *change)
{
    powers work;
    memcpy(&work, change + self->entries, sizeof work);
    return work;
}

/* Sizes of what works bring to the kinetic and the magnetic energy; the potential one follows the motion alone. */
static energies sizes_of(const ledger *self, const double *work)
{
    energies sum = {0, 0, 0};
    for (int i = 0; i < POWER_COUNT; i++) {
        const energies gain = power_gains(i, work[i], self->effects);
        sum.kinetic += fabs(gain.kinetic);
        sum.magnetic += fabs(gain.magnetic);
    }
    return sum;
}

/*
 * Whether the works of a part of a tick stand still, and the energies have gained what they bring, to rounding: that of
 * the energies there and of the part's works, and `share` of that of the whole run.
 */
static bool closes(const ledger *self, const place *from, const place *to, const double *change,
                   const double *error, double share)
{
    const powers work = works_of(self, change);
    const energies gap = less(less(to->energy, from->energy), powers_gains(&work, self->effects));
    const energies size = sizes_of(self, work.of);
    const energies off = sizes_of(self, error);
    const double least = share * size_of(self);
    const double kinetic = (double)MCT_REAL_EPSILON * (from->energy.kinetic + size.kinetic + least);
    const double magnetic = (double)MCT_REAL_EPSILON * (from->energy.magnetic + size.magnetic + least);
    return off.kinetic <= kinetic && off.magnetic <= magnetic && fabs(gap.kinetic) <= 8 * kinetic &&
           fabs(gap.magnetic) <= 8 * magnetic;
}

/* A part of a tick by extrapolation; false when it is too long for that. `rows`: how many it took. */
static bool advance(ledger *self, const place *from, double h, double share, place *to, double *change,
                    int *rows)
{
    const int all = self->entries + POWER_COUNT;
    vector table[ROWS];
    for (int k = 0; k < ROWS; k++) {
        vector gain;
        const bool smooth = midpoint(self, from, h, 2 * (k + 1), table[k]);
        for (int j = k - 1; j >= 0; j--) { /* table[j] becomes the extrapolation by rows j to k */
            const double ratio = (double)(k + 1) / (j + 1);
            const double weight = 1 / (ratio * ratio - 1);
            for (int i = 0; i < all; i++) {
                gain[i] = weight * (table[j + 1][i] - table[j][i]);
                table[j][i] = table[j + 1][i] + gain[i];
            }
        }
        *rows = k + 1;
        memcpy(change, table[0], sizeof table[0]);
        if (!smooth) {
            return false;
        }
        if (k >= 2) {
            move(self, from, change, to);
            if (closes(self, from, to, change, gain + self->entries, share) &&
                is_smooth(self, from, to->value, to->rate)) {
                return true;
            }
        }
    }
    return false;
}

/*
 * What meets a kink within the smallest part. What slows down to rest stops, and goes on at once unless friction holds
 * it; a distance that comes to nothing grows again, half a turn further.
 */
static void pass_kinks(ledger *self, const place *from, double h, place *to)
{
    const int rate = self->first_rate;
    for (int i = 0; i < self->coordinates && (self->effects & MCT_COULOMB) != 0; i++) {
        const double speed = slip(self, from->value, i);
        if (speed * (speed + 2 * h * from->rate[rate + i]) < 0) {
            to->value[rate + i] = self->belt_speed;
            to->rest[rate + i] = 0;
        }
    }
    if (is_distance(self) && from->value[0] + 2 * h * from->rate[0] <= 0) {
        to->value[0] = fmax(fabs(to->value[0]), from->value[0]);
        to->value[1] += PI;
        to->value[rate] = -to->value[rate];
        to->rest[0] = to->rest[rate] = 0;
    }
    arrive(self, to);
}

static bool is_finite(const ledger *self, const place *here)
{
    double sum = here->energy.kinetic + here->energy.potential + here->energy.magnetic;
    for (int i = 0; i < self->entries; i++) {
        sum += here->value[i];
    }
    return isfinite(sum);
}

/* The exact motion over a tick, and its works; false when it cannot be followed. */
static bool follow(ledger *self, place *end, account *work)
{
    place here = self->here;
    double left = 1, part = 1; /* of the tick */
    const double least = ldexp(1, -HALVINGS);
    memset(work, 0, POWER_COUNT * sizeof *work);
    for (int tries = 0; left > 0; tries++) {
        place next = here;
        vector change;
        int rows;
        const double length = fmin(part, left);
        const double share = length > STRICT ? 1e-3 : 8;
        const bool well = advance(self, &here, length * self->dt, share, &next, change, &rows);
        if (!well && length > least && tries < MOST_PARTS) {
            part = length / 2;
            continue;
        }
        if (!well) {
            move(self, &here, change, &next);
            pass_kinks(self, &here, length * self->dt, &next);
        }
        if (!is_finite(self, &next) || tries >= MOST_PARTS) {
            return false;
        }
        for (int i = 0; i < POWER_COUNT; i++) {
            add(&work[i], change[self->entries + i]);
        }
        left -= length;
        part = rows <= 4 ? 8 * length : rows <= 6 ? 2 * length : length;
        here = next;
    }
    *end = here;
    return true;
}

/* --- the run --- */

/* Phases grow at constant rates: one short step shows them. */
static mct_status find_phase_rates(ledger *self, const mct_scene *scene, mct_message *why)
{
    mct_state state;
    const double h = ldexp(mct_scene_step(scene), -20);
    const int first = self->first_rate + self->coordinates;
    if (self->system->phases == NULL || self->states == first) {
        return MCT_OK;
    }
    const mct_status status = self->system->prepare(scene, h, &self->constants, why);
    memset(&state, 0, sizeof state);
    if (status == MCT_OK) {
        self->system->kernel(scene->stepper, self->effects)->function(&self->constants, &state, 0, 1);
    }
    for (int i = 0; i < MCT_PHASES; i++) {
        self->phase_rate[i] = ((double)state.x[first + i] + (double)state.c[first + i]) / h;
    }
    return status;
}

mct_status ledger_begin(const mct_scene *scene, ledger **made, mct_message *why)
{
    mct_scene varied; /* as the plant has it */
    mct_scene_vary(scene, &varied);
    ledger *self = need_memory(calloc(1, sizeof *self));
    self->system = mct_systems[scene->system];
    self->effects = mct_scene_effects(&varied);
    self->coordinates = mct_coordinate_count(scene);
    self->first_rate = mct_rate_index(self->system);
    self->states = mct_state_count(scene);
    self->entries = self->states + (self->system->is_timed ? 1 : 0);
    self->dt = scene->dt;
    for (int i = 0; i < self->system->parameter_count; i++) {
        if (strcmp(self->system->parameters[i].name, "belt_speed") == 0) {
            self->belt_speed = (double)(mct_real)varied.parameters[i];
        }
    }
    mct_status status = find_phase_rates(self, &varied, why);
    status = status != MCT_OK ? status
                              : self->system->prepare(&varied, mct_scene_step(scene), &self->constants, why);
    if (status != MCT_OK) {
        free(self);
        return status;
    }
    *made = self;
    return MCT_OK;
}

static void take_size(ledger *self, const energies *at)
{
    self->largest = fmax(self->largest, fabs(at->kinetic) + fabs(at->potential) + fabs(at->magnetic));
}

/* Enters the exact motion of the tick that leads to `to`. */
static void enter(ledger *self, const place *to)
{
    account work[POWER_COUNT];
    powers done;
    place end;
    if (self->lost_ticks >= MOST_LOST || !follow(self, &end, work)) {
        self->lost_ticks++;
        add_energies(&self->unexplained, less(to->energy, self->here.energy));
        return;
    }
    for (int i = 0; i < POWER_COUNT; i++) {
        done.of[i] = value_of(work[i]);
        self->works += fabs(done.of[i]);
        add(&self->work[i], work[i].sum);
        add(&self->work[i], work[i].rest);
    }
    const energies gain = powers_gains(&done, self->effects);
    add_energies(&self->unexplained, less(less(end.energy, self->here.energy), gain));
    add_energies(&self->of_stepper, less(to->energy, end.energy));
}

/* A plant's quaternion has the length 1 to its own rounding. */
static void normalise(const ledger *self, place *here)
{
    double *const q = here->value + self->first_rate - 4;
    const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; i++) {
        q[i] /= length;
        here->rest[self->first_rate - 4 + i] = 0;
    }
}

void ledger_tick(ledger *self, const double *value, const double *rest, double input)
{
    place to;
    memset(&to, 0, sizeof to);
    for (int i = 0; i < self->entries; i++) {
        to.value[i] = value[i] + rest[i];
        to.rest[i] = rest[i] - (to.value[i] - value[i]);
    }
    if (self->system->attitude != MCT_ATTITUDE_NONE) {
        normalise(self, &to);
    }
    self->input = input;
    if (self->calls > 0) { /* the rates there, under the input that is held now */
        place here = self->here;
        arrive(self, &here);
        self->here = here;
        take_size(self, &here.energy);
    }
    arrive(self, &to);
    take_size(self, &to.energy);
    if (self->calls == 0) {
        self->start = to.energy;
    } else {
        enter(self, &to);
    }
    self->here = to;
    self->calls++;
}

void ledger_end(ledger *self, ledger_result *result)
{
    for (int i = 0; i < POWER_COUNT; i++) {
        result->work.of[i] = value_of(self->work[i]);
    }
    result->gain = less(self->here.energy, self->start);
    result->of_stepper = values_of(&self->of_stepper);
    result->unexplained = values_of(&self->unexplained);
    result->size = size_of(self);
    result->lost_ticks = self->lost_ticks;
    free(self);
}
