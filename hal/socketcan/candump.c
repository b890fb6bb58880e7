#include "hal/socketcan/candump.h"

#include <string.h>

#include "hal/socketcan/filter.h"

/* --- lines --- */

typedef struct {
    mct_can_frame frame; /* time_us: the time stamp as logged */
    bool blank;
    bool error;  /* of the controller */
    size_t next; /* where the next line begins */
} line;

typedef struct {
    const char *at, *end;
} span;

static bool skip(span *rest, char letter)
{
    const bool found = rest->at < rest->end && *rest->at == letter;
    rest->at += found;
    return found;
}

static int hex_digit(const span *rest)
{
    const char letter = rest->at < rest->end ? *rest->at : '\0';
    return letter >= '0' && letter <= '9'   ? letter - '0'
           : letter >= 'A' && letter <= 'F' ? letter - 'A' + 10
           : letter >= 'a' && letter <= 'f' ? letter - 'a' + 10
                                            : -1;
}

/* Digits of a base, at most `most`. @return how many there were */
static int read_digits(span *rest, int base, int most, int64_t *value)
{
    int count = 0;
    *value = 0;
    for (; count < most; count++) {
        const int digit = hex_digit(rest);
        if (digit < 0 || digit >= base) {
            break;
        }
        *value = *value * base + digit;
        rest->at++;
    }
    return count;
}

/* "(1436509052.249713) " */
static const char *read_stamp(span *rest, int64_t *us)
{
    static const char *const allowed = "allowed a time stamp such as (1436509052.249713)";
    int64_t seconds, fraction;
    if (!skip(rest, '(') || read_digits(rest, 10, 12, &seconds) == 0 || !skip(rest, '.')) {
        return allowed;
    }
    const int places = read_digits(rest, 10, 9, &fraction);
    if ((places != 6 && places != 9) || !skip(rest, ')') || !skip(rest, ' ')) {
        return allowed;
    }
    *us = seconds * 1000000 + (places == 9 ? fraction / 1000 : fraction);
    return NULL;
}

/* "can0 " */
static const char *read_interface(span *rest)
{
    const char *begin = rest->at;
    while (rest->at < rest->end && *rest->at != ' ') {
        rest->at++;
    }
    return rest->at > begin && skip(rest, ' ') ? NULL
                                               : "allowed a time stamp, an interface, then identifier#data";
}

/* "123#" */
static const char *read_identifier(span *rest, line *found)
{
    int64_t id;
    const int digits = read_digits(rest, 16, 8, &id);
    if ((digits != 3 && digits != 8) || !skip(rest, '#')) {
        return "allowed an identifier of 3 or 8 hexadecimal digits and '#'";
    }
    if (skip(rest, '#')) {
        return "this is a CAN FD frame; allowed classic ones, identifier#data: record a bus without CAN FD";
    }
    found->frame.extended = digits == 8;
    found->error = digits == 8 && id >= 0x20000000 && id <= 0x3FFFFFFF;
    if (!found->error && id > (digits == 8 ? 0x1FFFFFFF : 0x7FF)) {
        return "allowed identifiers up to 7FF or 1FFFFFFF";
    }
    found->frame.id = (uint32_t)id;
    return NULL;
}

/* "0011AABB" or "R3" */
static const char *read_data(span *rest, mct_can_frame *frame)
{
    int64_t byte = 0;
    if (skip(rest, 'R')) {
        frame->remote = true;
        if (read_digits(rest, 10, 1, &byte) == 1) {
            frame->length = (uint8_t)byte;
        }
        return frame->length <= 8 ? NULL : "allowed up to R8";
    }
    while (frame->length < 8 && hex_digit(rest) >= 0) {
        if (read_digits(rest, 16, 2, &byte) != 2) {
            return "allowed two hexadecimal digits for each byte";
        }
        frame->data[frame->length++] = (uint8_t)byte;
    }
    return NULL;
}

/* Reads the line at `at`. @return NULL, or what is allowed where it is not in order */
static const char *read_line(const mct_can_candump *log, size_t at, line *found)
{
    const char *begin = log->text + at;
    const char *newline = memchr(begin, '\n', log->length - at);
    const char *end = newline != NULL ? newline : log->text + log->length;
    const char *fault;
    memset(found, 0, sizeof *found);
    found->next = newline != NULL ? (size_t)(newline - log->text) + 1 : log->length;
    if (end > begin && end[-1] == '\r') {
        end--;
    }
    span rest = {begin, end};
    found->blank = begin == end;
    if (found->blank) {
        return NULL;
    }
    if ((fault = read_stamp(&rest, &found->frame.time_us)) != NULL ||
        (fault = read_interface(&rest)) != NULL || (fault = read_identifier(&rest, found)) != NULL ||
        (fault = read_data(&rest, &found->frame)) != NULL) {
        return fault;
    }
    if (skip(&rest, ' ') && !skip(&rest, 'R') && !skip(&rest, 'T')) {
        return "allowed nothing behind the data, or the direction R or T";
    }
    return rest.at == rest.end ? NULL : "allowed up to 8 bytes of data, at the end R or T";
}

/* The next frame at or behind `*at`, which moves to its line. False at the end of the log. */
static bool next_frame(const mct_can_candump *log, size_t *at, line *found)
{
    while (*at < log->length) {
        if (read_line(log, *at, found) != NULL) {
            return false; /* checked at open: only when the text has changed since */
        }
        if (!found->blank && !found->error) {
            return true;
        }
        *at = found->next;
    }
    return false;
}

/* --- whose a frame is --- */

static bool is_same_kind(const mct_can_frame *a, const mct_can_frame *b)
{
    return a->id == b->id && a->extended == b->extended && a->remote == b->remote;
}

static bool is_wanted(const mct_can_candump *self, const mct_can_frame *frame)
{
    return mct_can_is_wanted(self->filters, self->filter_count, frame);
}

static bool is_own(const mct_can_candump *self, const mct_can_frame *frame)
{
    for (int i = 0; i < self->sent_count; i++) {
        if (is_same_kind(&self->sent[i], frame)) {
            return true;
        }
    }
    for (int i = 0; i < self->own_count; i++) {
        if (self->own[i].id == frame->id && self->own[i].extended == frame->extended) {
            return true;
        }
    }
    return self->own_count == 0 && !is_wanted(self, frame);
}

static void remember_sent(mct_can_candump *self, const mct_can_frame *frame)
{
    bool known = false;
    for (int i = 0; i < self->sent_count; i++) {
        known |= is_same_kind(&self->sent[i], frame);
    }
    if (!known && self->sent_count < MCT_CAN_LOG_IDS) {
        self->sent[self->sent_count++] = *frame;
    }
}

/* --- the position --- */

static void move_behind(mct_can_candump *self, const line *passed)
{
    const int64_t us = passed->frame.time_us - self->first_us;
    self->log_us =
        us > self->log_us ? us : self->log_us; /* stamps may go back a little: the clock does not */
    self->position = passed->next;
}

/* The next frame to receive, the position before it. False when an own one comes first, or the end. */
static bool find_wanted(mct_can_candump *self, line *found)
{
    while (next_frame(self, &self->position, found)) {
        if (is_own(self, &found->frame)) {
            return false;
        }
        if (is_wanted(self, &found->frame)) {
            return true;
        }
        move_behind(self, found);
    }
    return false;
}

static bool has_ended(mct_can_candump *self)
{
    line found;
    return self->position > self->last_wanted || (self->stuck && !find_wanted(self, &found));
}

/* --- the transport --- */

static void explain(const mct_can_candump *self, size_t at, uint64_t number, const char *allowed,
                    mct_message *why)
{
    const char *newline = memchr(self->text + at, '\n', self->length - at);
    const size_t rest = newline != NULL ? (size_t)(newline - self->text) - at : self->length - at;
    mct_message_add(why, "line ");
    mct_message_add_integer(why, (long long)number);
    mct_message_add(why, " of the CAN log: found \"");
    mct_message_add_span(why, self->text + at, rest < 80 ? rest : 80);
    mct_message_add(why, rest > 80 ? "...\"; " : "\"; ");
    mct_message_add(why, allowed);
}

/* Reads the whole log once. */
static bool check_log(mct_can_candump *self, mct_message *why)
{
    bool wanted = false;
    uint64_t number = 0;
    line found;
    self->lines = 0;
    for (size_t at = 0; at < self->length; at = found.next) {
        const char *allowed = read_line(self, at, &found);
        number++;
        if (allowed != NULL) {
            explain(self, at, number, allowed, why);
            return false;
        }
        if (!found.blank && !found.error) {
            self->first_us = self->lines == 0 ? found.frame.time_us : self->first_us;
            self->lines++;
            if (is_wanted(self, &found.frame) && !is_own(self, &found.frame)) {
                self->last_wanted = at;
                wanted = true;
            }
        }
    }
    if (!wanted) {
        mct_message_add(why, "the CAN log holds ");
        mct_message_add_integer(why, (long long)self->lines);
        mct_message_add(
            why, " frames, none of them with an identifier that is listened to; allowed a log of these "
                 "drives: look at their protocol and node numbers");
    }
    return wanted;
}

static mct_status candump_open(void *context, const mct_can_filter *filters, int count,
                               mct_can_counts *counts, mct_message *why)
{
    mct_can_candump *self = context;
    if (!mct_can_check_filters(filters, count, why)) {
        return MCT_ERROR_IO;
    }
    for (int i = 0; i < count; i++) {
        self->filters[i] = filters[i];
    }
    self->filter_count = count;
    self->counts = counts;
    self->sent_count = 0;
    if (!check_log(self, why)) {
        return MCT_ERROR_IO;
    }
    self->compared = self->mismatches = self->unmatched = 0;
    self->position = 0;
    self->log_us = self->waited_us = 0;
    self->stuck = false;
    self->open = true;
    return MCT_OK;
}

/* Moves behind the next logged frame of this kind; false when there is none in reach. */
static bool follow(mct_can_candump *self, const mct_can_frame *frame, line *found)
{
    uint64_t passed = 0;
    size_t at = self->position;
    if (!next_frame(self, &at, found)) {
        return false;
    }
    const int64_t reach_us = found->frame.time_us + MCT_CAN_LOG_REACH_US;
    while (next_frame(self, &at, found) && found->frame.time_us <= reach_us) {
        if (is_same_kind(&found->frame, frame)) {
            move_behind(self, found);
            mct_hal_count(&self->counts->values[MCT_CAN_COUNT_SKIPPED], passed);
            return true;
        }
        passed += is_wanted(self, &found->frame) && !is_own(self, &found->frame);
        at = found->next;
    }
    return false;
}

static bool candump_send(void *context, const mct_can_frame *frame)
{
    mct_can_candump *self = context;
    line found;
    if (!self->open) {
        return false;
    }
    remember_sent(self, frame);
    self->stuck = !follow(self, frame, &found);
    if (!self->stuck) {
        const uint8_t length = frame->length <= 8 ? frame->length : 8;
        self->compared++;
        self->mismatches +=
            length != found.frame.length || memcmp(frame->data, found.frame.data, length) != 0;
        mct_can_counted(self->counts, MCT_CAN_COUNT_CONFIRMED);
    } else {
        self->unmatched++;
        if (has_ended(self)) {
            return false;
        }
    }
    mct_can_counted(self->counts, MCT_CAN_COUNT_SENT);
    return true;
}

static bool candump_receive(void *context, mct_can_frame *frame)
{
    mct_can_candump *self = context;
    line found;
    if (!self->open || !find_wanted(self, &found)) {
        return false;
    }
    move_behind(self, &found);
    *frame = found.frame;
    frame->time_us = self->log_us + self->waited_us;
    return true;
}

static bool candump_wait(void *context, int64_t timeout_us)
{
    mct_can_candump *self = context;
    line found;
    if (self->open && find_wanted(self, &found)) {
        return true;
    }
    self->waited_us += timeout_us > 0 ? timeout_us : 0;
    return false;
}

static int64_t candump_now_us(void *context)
{
    const mct_can_candump *self = context;
    return self->log_us + self->waited_us;
}

static mct_can_link_state candump_tend(void *context)
{
    mct_can_candump *self = context;
    return self->open && !has_ended(self) ? MCT_CAN_UP : MCT_CAN_END_OF_LOG;
}

static void candump_close(void *context)
{
    mct_can_candump *self = context;
    self->open = false;
}

mct_can_transport mct_can_candump_transport(mct_can_candump *log, const char *text, size_t length)
{
    static const mct_can_transport_ops ops = {
        .name = "candump",
        .simulated = true,
        .open = candump_open,
        .send = candump_send,
        .receive = candump_receive,
        .wait = candump_wait,
        .now_us = candump_now_us,
        .tend = candump_tend,
        .close = candump_close,
    };
    memset(log, 0, sizeof *log);
    log->text = text;
    log->length = length;
    return (mct_can_transport){&ops, log};
}
