#include "support/textbook.h"

#include <math.h>
#include <string.h>

static quad parameter(const textbook *self, const char *name)
{
    return (quad)*parameter_of((mct_scene *)self->scene, name); /* read, not written */
}

/* A parameter, if an effect is on. */
static quad with(const textbook *self, uint32_t effect, const char *name)
{
    return (self->scene->effects & effect) ? parameter(self, name) : 0;
}

/* --- cart_pole, reaction_wheel --- */

static void central_rate(const void *model, quad time, const quad *x, quad *dx)
{
    const textbook *self = model;
    quad all[REFERENCE_STATES] = {0}, rates[REFERENCE_STATES];
    (void)time;
    memcpy(all, x, sizeof(quad) * (size_t)self->states);
    reference_rate(&self->central, all, self->input, rates);
    memcpy(dx, rates, sizeof(quad) * (size_t)self->states);
}

static void start_central(textbook *self)
{
    self->rate = central_rate;
    self->central = reference_of(self->scene);
}

/* --- bodies on an axis: I a = axis . sum x m g - nu w + torque --- */

static void hinge_rate(const void *model, quad time, const quad *x, quad *dx)
{
    const textbook *self = model;
    const quad *u = self->hinge.axis;
    quad inertia = self->hinge.inertia, torque = self->input - self->hinge.friction * x[1];
    (void)time;
    for (int n = 0; n < self->hinge.count; n++) {
        const quad *b = self->hinge.place[n];
        quad across[3], place[3], lever[3];
        const quad along = u[0] * b[0] + u[1] * b[1] + u[2] * b[2];
        quad_cross(u, b, across);
        for (int i = 0; i < 3; i++) {
            place[i] = along * u[i] + quad_cos(x[0]) * (b[i] - along * u[i]) + quad_sin(x[0]) * across[i];
        }
        quad_cross(place, self->hinge.gravity, lever);
        for (int i = 0; i < 3; i++) {
            inertia += self->hinge.mass[n] * across[i] * across[i];
            torque += self->hinge.mass[n] * u[i] * lever[i];
        }
    }
    dx[0] = x[1];
    dx[1] = torque / inertia;
}

static void start_hinge(textbook *self)
{
    self->rate = hinge_rate;
    self->hinge.friction = with(self, MCT_VISCOUS, "friction");
    self->hinge.count = 1;
}

static void start_pendulum(textbook *self)
{
    start_hinge(self);
    self->hinge.axis[2] = -1;
    self->hinge.gravity[1] = -with(self, MCT_GRAVITY, "gravity");
    self->hinge.mass[0] = parameter(self, "mass");
    self->hinge.place[0][1] = parameter(self, "length");
}

static void start_solid(textbook *self)
{
    const quad x = parameter(self, "size_1"), y = parameter(self, "size_2");
    start_hinge(self);
    self->hinge.axis[2] = 1;
    self->hinge.gravity[1] = -with(self, MCT_GRAVITY, "gravity");
    self->hinge.mass[0] = parameter(self, "density") * x * y * parameter(self, "size_3");
    self->hinge.place[0][0] = x / 2 - parameter(self, "pivot_offset");
    self->hinge.inertia = self->hinge.mass[0] * (x * x + y * y) / 12;
}

static void take_particles(textbook *self, int columns)
{
    const mct_list *list = &self->scene->lists[0];
    start_hinge(self);
    self->hinge.count = list->count / columns;
    for (int n = 0; n < self->hinge.count; n++) {
        self->hinge.mass[n] = (quad)list->values[n * columns];
        for (int i = 1; i < columns; i++) {
            self->hinge.place[n][i - 1] = (quad)list->values[n * columns + i];
        }
    }
}

static void start_plane_particles(textbook *self)
{
    take_particles(self, 3);
    self->hinge.axis[2] = -1;
    self->hinge.gravity[1] = -with(self, MCT_GRAVITY, "gravity");
}

static void start_axis(textbook *self)
{
    static const char *const axes[] = {"axis_1", "axis_2", "axis_3"};
    static const char *const gravity[] = {"gravity_1", "gravity_2", "gravity_3"};
    quad square = 0;
    take_particles(self, 4);
    for (int i = 0; i < 3; i++) {
        self->hinge.axis[i] = parameter(self, axes[i]);
        self->hinge.gravity[i] = with(self, MCT_GRAVITY, gravity[i]);
        square += self->hinge.axis[i] * self->hinge.axis[i];
    }
    for (int i = 0; i < 3; i++) {
        self->hinge.axis[i] /= quad_sqrt(square);
    }
}

/* --- moving_base: section 2.6 --- */

static void base_rate(const void *model, quad time, const quad *x, quad *dx)
{
    const textbook *self = model;
    const quad m = parameter(self, "mass"), l = parameter(self, "length");
    const quad f1 = parameter(self, "base_frequency_1"), f2 = parameter(self, "base_frequency_2");
    const quad a1 = -with(self, MCT_BASE_MOTION, "base_amplitude_1") * f1 * f1 *
                    quad_cos(f1 * time + parameter(self, "base_phase_1"));
    const quad a2 = -with(self, MCT_BASE_MOTION, "base_amplitude_2") * f2 * f2 *
                    quad_cos(f2 * time + parameter(self, "base_phase_2"));
    dx[0] = x[1];
    dx[1] = (m * with(self, MCT_GRAVITY, "gravity") * l * quad_sin(x[0]) -
             with(self, MCT_VISCOUS, "friction") * x[1] -
             m * l * (a1 * quad_cos(x[0]) - a2 * quad_sin(x[0])) + self->input) /
            (m * l * l);
}

static void start_base(textbook *self)
{
    self->rate = base_rate;
}

/* --- spring_pendulum: section 1.3 --- */

static void spring_rate(const void *model, quad time, const quad *x, quad *dx)
{
    const textbook *self = model;
    const quad m = parameter(self, "mass"), g = with(self, MCT_GRAVITY, "gravity");
    const quad k = with(self, MCT_SPRING, "stiffness");
    (void)time;
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] =
        x[0] * x[3] * x[3] - g * quad_sin(x[1]) -
        (k * (x[0] - parameter(self, "rest_length")) + with(self, MCT_VISCOUS, "length_friction") * x[2]) / m;
    dx[3] = (self->input - with(self, MCT_VISCOUS, "angle_friction") * x[3] - m * g * x[0] * quad_cos(x[1]) -
             2 * m * x[0] * x[2] * x[3]) /
            (m * x[0] * x[0]);
}

static void start_spring(textbook *self)
{
    self->rate = spring_rate;
}

/* --- bodies --- */

static void free_rate(const void *model, quad time, const quad *x, quad *dx)
{
    body_rate(&((const textbook *)model)->body, time, x, dx);
}

static void take_body(textbook *self, const double *point)
{
    static const char *const gravity[] = {"gravity_1", "gravity_2", "gravity_3"};
    self->body = body_of_rows(self->scene, point);
    self->rate = free_rate;
    self->states = BODY_STATES;
    for (int i = 0; i < 3; i++) {
        self->body.gravity[i] = with(self, MCT_GRAVITY, gravity[i]);
    }
}

static void start_ball_joint(textbook *self)
{
    const double pivot[3] = {0};
    take_body(self, pivot);
    self->body.is_on_pivot = true;
    self->body.friction = with(self, MCT_VISCOUS, "friction");
}

/* Of particles; each row of forces is: in space or in the body, point, force. */
static void start_rigid_body(textbook *self)
{
    const mct_list *forces = &self->scene->lists[1];
    double centre[3] = {0}, mass = 0;
    for (int n = 0; n < self->scene->lists[0].count; n += 4) {
        const double *row = self->scene->lists[0].values + n;
        mass += row[0];
        for (int i = 0; i < 3; i++) {
            centre[i] += row[0] * row[1 + i];
        }
    }
    for (int i = 0; i < 3; i++) {
        centre[i] /= mass;
    }
    take_body(self, centre);
    memset(self->body.first_moment, 0, sizeof self->body.first_moment);
    self->body.forces = (self->scene->effects & MCT_FORCES) ? forces->count / 7 : 0;
    for (int n = 0; n < self->body.forces; n++) {
        const double *row = forces->values + 7 * n;
        self->body.in_body[n] = row[0] == 1;
        for (int i = 0; i < 3; i++) {
            self->body.point[n][i] = (quad)row[1 + i] - (quad)centre[i];
            self->body.force[n][i] = (quad)row[4 + i];
        }
    }
}

/* --- all --- */

bool textbook_of(textbook *self, const mct_scene *scene, double input)
{
    static const struct {
        const char *name;
        void (*start)(textbook *self);
    } books[] = {
        {"cart_pole", start_central},     {"reaction_wheel", start_central},
        {"pendulum", start_pendulum},     {"particle_pendulum", start_plane_particles},
        {"fixed_axis", start_axis},       {"solid_pendulum", start_solid},
        {"moving_base", start_base},      {"spring_pendulum", start_spring},
        {"ball_joint", start_ball_joint}, {"rigid_body", start_rigid_body},
    };
    for (size_t i = 0; i < sizeof books / sizeof books[0]; i++) {
        if (strcmp(books[i].name, mct_systems[scene->system]->name) == 0) {
            memset(self, 0, sizeof *self);
            self->scene = scene;
            self->input = (quad)input;
            self->states =
                mct_state_count(scene) - (mct_systems[scene->system]->phases != NULL ? MCT_PHASES : 0);
            books[i].start(self);
            return true;
        }
    }
    return false;
}

void textbook_start(const textbook *self, const mct_plant *plant, quad *x)
{
    for (int i = 0; i < self->states && self->rate != free_rate; i++) {
        x[i] = (quad)mct_plant_value(plant, i);
    }
    if (self->rate == free_rate) {
        body_of_plant(plant, x);
    }
}

double textbook_distance(const textbook *self, const mct_plant *plant, const quad *x)
{
    quad now[QUAD_MAX_STATES];
    textbook_start(self, plant, now);
    if (self->rate == free_rate) {
        return body_distance(now, x);
    }
    double worst = 0;
    for (int i = 0; i < self->states; i++) {
        worst = fmax(worst, (double)quad_abs(now[i] - x[i]) / fmax(1, (double)quad_abs(x[i])));
    }
    return worst;
}
