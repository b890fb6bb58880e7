/*
 * Bodies by the textbook, for tests of ball_joint and rigid_body: from the scene's numbers, not from their
 * constants.
 */
#ifndef MCT_TEST_BODIES_H
#define MCT_TEST_BODIES_H

#include <string.h>

#include "support/quad.h"
#include "support/scenes.h"

enum {
    BODY_W = 4,
    BODY_X = 7,
    BODY_V = 10,
    BODY_STATES = 13
}; /* attitude, angular velocity in body axes, place, velocity */

/*
 * What turns and moves: all about the point that it turns about, in body axes but for what is called space.
 */
typedef struct {
    bool is_on_pivot;
    quad mass, inertia[3][3];
    quad first_moment[3]; /* about the pivot; 0 about the centre */
    quad gravity[3];
    quad friction;           /* of the angular velocity */
    quad drag, angular_drag; /* of the squares */
    int forces;
    bool in_body[4];
    quad point[4][3], force[4][3];
} textbook_body;

/* Sets one of a scene's lists. */
static inline void set_rows(mct_scene *scene, int list, const double *values, int numbers)
{
    scene->lists[list].count = numbers;
    if (numbers > 0) {
        memcpy(scene->lists[list].values, values, sizeof(double) * (size_t)numbers);
    }
}

static inline void quad_cross(const quad *a, const quad *b, quad *product)
{
    for (int i = 0; i < 3; i++) {
        product[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    }
}

/* The matrix of a quaternion, of any length, divided by its square. */
static inline void quad_matrix(const quad *q, quad (*r)[3])
{
    const quad square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        r[i][i] = 1 - 2 * (q[1 + j] * q[1 + j] + q[1 + k] * q[1 + k]) / square;
        r[i][j] = 2 * (q[1 + i] * q[1 + j] - q[0] * q[1 + k]) / square;
        r[i][k] = 2 * (q[1 + i] * q[1 + k] + q[0] * q[1 + j]) / square;
    }
}

/* Mass, first moment and inertia of a scene's particles about a point of the body. */
static inline textbook_body body_of_rows(const mct_scene *scene, const double *point)
{
    textbook_body self = {0};
    for (int n = 0; n < scene->lists[0].count; n += 4) {
        const double *row = scene->lists[0].values + n;
        quad b[3], square = 0;
        for (int i = 0; i < 3; i++) {
            b[i] = (quad)row[1 + i] - (quad)point[i];
            square += b[i] * b[i];
        }
        self.mass += (quad)row[0];
        for (int i = 0; i < 3; i++) {
            self.first_moment[i] += (quad)row[0] * b[i];
            for (int j = 0; j < 3; j++) {
                self.inertia[i][j] += (quad)row[0] * ((i == j ? square : 0) - b[i] * b[j]);
            }
        }
    }
    return self;
}

static inline void quad_solve3(const quad (*a)[3], const quad *b, quad *x)
{
    quad across[3][3], determinant = 0;
    for (int i = 0; i < 3; i++) {
        quad_cross(a[(i + 1) % 3], a[(i + 2) % 3], across[i]);
    }
    for (int i = 0; i < 3; i++) {
        determinant += a[0][i] * across[0][i];
    }
    for (int i = 0; i < 3; i++) {
        x[i] = (across[0][i] * b[0] + across[1][i] * b[1] + across[2][i] * b[2]) / determinant;
    }
}

/* Euler's two laws. */
static inline void body_rate(const void *model, quad time, const quad *x, quad *dx)
{
    const textbook_body *self = model;
    const quad *w = x + BODY_W, *v = x + BODY_V;
    quad r[3][3], back[3], couple[3], force[3] = {0}, momentum[3], gyroscopic[3], part[3];
    (void)time;
    quad_matrix(x, r);
    for (int i = 0; i < 3; i++) {
        back[i] = r[0][i] * self->gravity[0] + r[1][i] * self->gravity[1] + r[2][i] * self->gravity[2];
        momentum[i] = self->inertia[i][0] * w[0] + self->inertia[i][1] * w[1] + self->inertia[i][2] * w[2];
    }
    const quad speed = quad_sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    const quad spin = quad_sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    quad_cross(self->first_moment, back, couple);
    quad_cross(w, momentum, gyroscopic);
    for (int n = 0; n < self->forces; n++) {
        const quad *f = self->force[n];
        quad body[3], space[3];
        for (int i = 0; i < 3; i++) {
            body[i] = self->in_body[n] ? f[i] : r[0][i] * f[0] + r[1][i] * f[1] + r[2][i] * f[2];
            space[i] = self->in_body[n] ? r[i][0] * f[0] + r[i][1] * f[1] + r[i][2] * f[2] : f[i];
        }
        quad_cross(self->point[n], body, part);
        for (int i = 0; i < 3; i++) {
            couple[i] += part[i];
            force[i] += space[i];
        }
    }
    for (int i = 0; i < 3; i++) {
        couple[i] -= (self->friction + self->angular_drag * spin) * w[i] + gyroscopic[i];
        const quad acceleration = (force[i] - self->drag * speed * v[i]) / self->mass + self->gravity[i];
        dx[BODY_X + i] = v[i];
        dx[BODY_V + i] = self->is_on_pivot ? 0 : acceleration;
    }
    quad_solve3(self->inertia, couple, dx + BODY_W);
    dx[0] = -(x[1] * w[0] + x[2] * w[1] + x[3] * w[2]) / 2;
    dx[1] = (x[0] * w[0] + x[2] * w[2] - x[3] * w[1]) / 2;
    dx[2] = (x[0] * w[1] + x[3] * w[0] - x[1] * w[2]) / 2;
    dx[3] = (x[0] * w[2] + x[1] * w[1] - x[2] * w[0]) / 2;
}

/* Angle between two attitudes, q and -q being one [rad]; either may be of any length. */
static inline double angle_between(const quad *a, const quad *b)
{
    quad sizes = 0, along = 0, vector[3];
    quad_cross(a + 1, b + 1, vector);
    for (int i = 0; i < 4; i++) {
        along += a[i] * b[i];
    }
    for (int i = 0; i < 3; i++) {
        vector[i] += b[0] * a[1 + i] - a[0] * b[1 + i];
        sizes += vector[i] * vector[i];
    }
    return (double)(2 * quad_sqrt(sizes) / quad_abs(along)); /* a small one: the tangent of its half */
}

/* The state of a plant of either system as the textbook has it. */
static inline void body_of_plant(const mct_plant *plant, quad *x)
{
    const int n = plant->system->coordinate_count, rate = mct_rate_index(plant->system);
    quad r[3][3], w[3];
    for (int i = 0; i < 4; i++) {
        x[i] = (quad)mct_plant_value(plant, n - 3 + i);
    }
    for (int i = 0; i < 3; i++) {
        w[i] = (quad)mct_plant_value(plant, rate + n - 3 + i);
        x[BODY_X + i] = n == 6 ? (quad)mct_plant_value(plant, i) : 0;
        x[BODY_V + i] = n == 6 ? (quad)mct_plant_value(plant, rate + i) : 0;
    }
    quad_matrix(x, r);
    for (int i = 0; i < 3; i++) {
        x[BODY_W + i] = plant->system->attitude == MCT_ATTITUDE_BODY
                            ? w[i]
                            : r[0][i] * w[0] + r[1][i] * w[1] + r[2][i] * w[2];
    }
}

/* Worst of attitude [rad], angular velocity, place and velocity. */
static inline double body_distance(const quad *a, const quad *b)
{
    double worst = angle_between(a, b);
    for (int i = BODY_W; i < BODY_STATES; i++) {
        const double off = (double)quad_abs(a[i] - b[i]);
        worst = off > worst ? off : worst;
    }
    return worst;
}

/* The reference after `duration`, and how exact it is: its distance from one of steps twice as long. */
static inline double body_reference(const textbook_body *body, const quad *start, double duration, quad *end)
{
    quad coarse[BODY_STATES];
    memcpy(coarse, start, sizeof coarse);
    memcpy(end, start, sizeof coarse);
    quad_extrapolate(body_rate, body, 0, coarse, BODY_STATES, (quad)duration, (long)(40 * duration));
    quad_extrapolate(body_rate, body, 0, end, BODY_STATES, (quad)duration, (long)(80 * duration));
    return body_distance(coarse, end);
}

/* How much the motion amplifies an error of its angular velocity that is made on the way; at least 1. */
static inline double body_growth(const textbook_body *body, const quad *start, double duration,
                                 const quad *end)
{
    enum { PLACES = 5 };
    const quad nudge = (quad)1e-14;
    quad way[BODY_STATES];
    double growth = 1;
    memcpy(way, start, sizeof way);
    for (int place = 0; place < PLACES; place++) {
        const quad left = (quad)duration * (PLACES - place) / PLACES;
        for (int i = 0; i < 3; i++) {
            quad x[BODY_STATES];
            memcpy(x, way, sizeof x);
            x[BODY_W + i] += nudge;
            quad_extrapolate(body_rate, body, 0, x, BODY_STATES, left,
                             (long)(40 * duration) * (PLACES - place) / PLACES);
            const double factor = body_distance(x, end) / (double)nudge;
            growth = factor > growth ? factor : growth;
        }
        quad_extrapolate(body_rate, body, 0, way, BODY_STATES, (quad)duration / PLACES, (long)(8 * duration));
    }
    return growth;
}

#endif
