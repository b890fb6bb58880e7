#include "friction_exact.h"

enum { ITERATIONS = 12 }; /* of Newton's method */

bool mct_friction_next_mode(int *tried, mct_phase *phase, mct_real *required)
{
    enum { MODES = 9 };
    static const int8_t modes[MODES][2] = {{0, 0}, {1, 0},  {-1, 0}, {0, 1},  {0, -1},
                                           {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
    const int coordinates = phase->coordinates;
    mct_real *const direction = phase->slip.direction;
    if (*tried == 0) { /* all rest that may: a single load that is too large takes its coordinate away */
        int too_large = 0;
        int which = 0;
        for (int i = 0; i < coordinates; i++) {
            if (direction[i] == 0 && !(mct_friction_size(phase->loads[i][0]) <= phase->dry.hold[i])) {
                too_large++;
                which = i;
            }
        }
        if (too_large == 1) {
            required[which] = phase->loads[which][0] > 0 ? 1 : -1;
        }
    }
    while (++*tried < MODES) {
        const int8_t *const mode = modes[*tried];
        bool suits = coordinates > 1 || mode[1] == 0;
        for (int i = 0; i < coordinates; i++) {
            suits &= required[i] == 0 || required[i] == (mct_real)mode[i];
        }
        if (suits) {
            for (int i = 0; i < coordinates; i++) {
                direction[i] = (mct_real)mode[i];
            }
            return true;
        }
    }
    for (int i = 0; i < coordinates; i++) { /* a tie within rounding: what is too large breaks away at once */
        direction[i] = required[i];
    }
    return false;
}

static mct_real value_at(const mct_real *c, int order, mct_real s)
{
    mct_real sum = c[order];
    for (int n = order - 1; n >= 0; n--) {
        sum = sum * s + c[n];
    }
    return sum;
}

static mct_real slope_at(const mct_real *c, int order, mct_real s)
{
    mct_real sum = (mct_real)order * c[order];
    for (int n = order - 1; n >= 1; n--) {
        sum = sum * s + (mct_real)n * c[n];
    }
    return sum;
}

/* A root in [0, end] of a polynomial that is at least 0 at 0 and negative at the end. */
static mct_real root_of(const mct_real *c, int order, mct_real end)
{
    mct_real low = 0;
    mct_real high = end;
    mct_real s = end;
    for (int i = 0; i < ITERATIONS; i++) {
        const mct_real value = value_at(c, order, s);
        if (value < 0) {
            high = s;
        } else {
            low = s;
        }
        const mct_real next = s - value / slope_at(c, order, s);
        if (next == s) {
            break;
        }
        s = next >= low && next <= high ? next : MCT_R(0.5) * (low + high); /* also where the slope is 0 */
    }
    return s;
}

/* Where a polynomial that is at least 0 at 0 first becomes negative; `end` when it does not do so before. */
static mct_real first_crossing(const mct_real *c, int order, mct_real end)
{
    if (value_at(c, order, end) < 0) {
        return root_of(c, order, end);
    }
    /* It may have dipped below in between: down at the start, up at the end. */
    if (!(c[1] < 0 && slope_at(c, order, end) > 0)) {
        return end;
    }
    mct_series downward = {0}; /* - slope */
    for (int n = 0; n < order; n++) {
        downward[n] = -(mct_real)(n + 1) * c[n + 1];
    }
    const mct_real lowest = root_of(downward, order - 1, end);
    return value_at(c, order, lowest) < 0 ? root_of(c, order, lowest) : end;
}

/* c = start + sign (series without its first term) */
static void mirror(mct_real start, mct_real sign, const mct_real *series, int order, mct_real *c)
{
    c[0] = start;
    for (int n = 1; n <= order; n++) {
        c[n] = sign * series[n];
    }
}

/* When a coordinate that slides comes to rest. */
static mct_real stop_of(const mct_phase *phase, int i, mct_real end)
{
    mct_series along;
    mirror(mct_friction_size(phase->relative[i]), phase->slip.direction[i], phase->rates[i], phase->order,
           along);
    /* From rest, the start itself is no stop: the root at 0 is divided out. */
    return phase->relative[i] == 0 ? first_crossing(along + 1, phase->order - 1, end)
                                   : first_crossing(along, phase->order, end);
}

/* When the load on a coordinate at rest exceeds what holds it, and in which direction it leaves. */
static mct_real break_away_of(const mct_phase *phase, int i, mct_real end, mct_real *direction)
{
    mct_real soonest = end;
    for (int k = 0; k < 2; k++) {
        const mct_real side = k == 0 ? MCT_R(1.0) : MCT_R(-1.0);
        const int order = phase->order - 1;
        mct_series spare;
        mirror(phase->dry.hold[i] - side * phase->loads[i][0], -side, phase->loads[i], order, spare);
        const mct_real crossing = first_crossing(spare, order, soonest);
        if (crossing < soonest) {
            soonest = crossing;
            *direction = side;
        }
    }
    return soonest;
}

mct_real mct_friction_phase(const mct_phase *phase, bool is_last, const mct_real *x, mct_real *dx,
                            mct_real *gone)
{
    const int n = phase->coordinates;
    mct_real left = 1 - phase->slip.passed;
    mct_real length = left;
    int which = -1; /* of the coordinates the event is about */
    mct_real leaves = 0;
    for (int i = 0; i < n && !is_last; i++) {
        mct_real direction = 0;
        const mct_real end = phase->slip.direction[i] == 0 ? break_away_of(phase, i, length, &direction)
                                                           : stop_of(phase, i, length);
        if (end < length) {
            length = end;
            which = i;
            leaves = direction;
        }
    }
    for (int i = 0; i < phase->rows; i++) {
        const mct_real *const rate = phase->rates[i];
        mct_real way = 0;
        for (int k = phase->order; k >= 0 && i < n; k--) {
            way = way * length + mct_series_share(k) * rate[k];
        }
        if (i < n) {
            dx[i] += phase->h * length * way;
            gone[i] = 0;
        }
        dx[n + i] += length * value_at(rate + 1, phase->order - 1, length);
    }
    if (which < 0) {
        return 0;
    }
    dx[n + which] = phase->dry.surface - x[n + which]; /* every event is at rest, exactly */
    gone[which] = leaves;
    left -= length;
    return left;
}
