// Boost.odeint on the shared closed form, inlined: fixed steps; adaptive ones, which keep their step from span to span
// and are reset where the input changes; with dense output where nothing is held.
#include "peers.h"

#include <algorithm>
#include <boost/array.hpp>
#include <boost/numeric/odeint.hpp>
#include <boost/version.hpp>
#include <memory>

namespace odeint = boost::numeric::odeint;

namespace {

const peer_method methods[] = {
    {"rk4", true},    {"dopri5, fixed", true},    {"fehlberg78, fixed", true}, {"cash_karp54", false},
    {"dopri5", false}, {"fehlberg78", false}, {"bulirsch_stoer", false}, {"dopri5, dense", false},
};
enum { RK4, DOPRI5_FIXED, FEHLBERG78_FIXED, CASH_KARP54, DOPRI5, FEHLBERG78, BULIRSCH_STOER, DOPRI5_DENSE, METHODS };

using rate_of = void(const double *k, double u, const double *x, double *dx);

struct run_base {
    virtual ~run_base() = default;
    virtual bool run(const double *inputs, double *samples) = 0;
};

// A scene's closed form as odeint wants it.
template <int N, rate_of *rate>
struct motion {
    using state = boost::array<double, N>;
    double k[SCENE_CONSTANTS];
    double input = 0;
    void operator()(const state &x, state &dx, double) const { rate(k, input, x.data(), dx.data()); }
};

template <class Stepper>
auto reset(Stepper &stepper, int) -> decltype(stepper.reset())
{
    stepper.reset();
}

template <class Stepper>
void reset(Stepper &, long)
{
}

template <class Motion>
struct run_common : run_base {
    const bench_scene *scene;
    Motion motion;
    typename Motion::state x;

    explicit run_common(const bench_scene *of) : scene(of) { scene_constants(of, motion.k); }

    template <class Advance>
    bool loop(const double *inputs, double *samples, Advance advance)
    {
        const int spans = scene_spans_per_sample(scene);
        std::copy_n(scene->start, x.size(), x.begin());
        motion.input = inputs[0];
        for (int sample = 0, span = 0; sample < SCENE_SAMPLES; sample++) {
            for (int k = 0; k < spans; k++, span++) {
                const bool changes = motion.input != inputs[span];
                motion.input = inputs[span];
                if (!advance(span, changes)) {
                    return false;
                }
            }
            std::copy(x.begin(), x.end(), samples + sample * scene->states);
            if (peer_is_late) {
                return false;
            }
        }
        return true;
    }
};

template <class Motion, class Stepper>
struct run_fixed : run_common<Motion> {
    int steps;
    run_fixed(const bench_scene *of, double setting) : run_common<Motion>(of), steps(static_cast<int>(setting)) {}
    bool run(const double *inputs, double *samples) override
    {
        Stepper stepper;
        const double h = scene_span(this->scene) / steps;
        return this->loop(inputs, samples, [&](int, bool changes) {
            if (changes) {
                reset(stepper, 0); // what is kept of the last step
            }
            for (int k = 0; k < steps; k++) {
                stepper.do_step(std::cref(this->motion), this->x, 0.0, h);
            }
            return true;
        });
    }
};

template <class Motion, class Stepper>
struct run_adaptive : run_common<Motion> {
    Stepper given;
    run_adaptive(const bench_scene *of, const Stepper &stepper) : run_common<Motion>(of), given(stepper) {}
    bool run(const double *inputs, double *samples) override
    {
        Stepper stepper(given);
        const double span = scene_span(this->scene);
        double next = 1e-4;
        return this->loop(inputs, samples, [&](int, bool changes) {
            if (changes) {
                reset(stepper, 0);
            }
            double t = 0;
            for (int tries = 0; t < span; tries++) {
                const bool is_last = next >= span - t;
                double h = is_last ? span - t : next;
                const auto result = stepper.try_step(std::cref(this->motion), this->x, t, h);
                if (result == odeint::fail) {
                    if (h < 1e-12 || tries > 1000000) {
                        return false;
                    }
                    next = h;
                    continue;
                }
                if (is_last) {
                    next = std::max(next, h); // what was cut off says nothing
                    break;
                }
                next = h;
            }
            return true;
        });
    }
};

// Free: the steps are its own, and samples are read between them.
template <class Motion, class Stepper>
struct run_dense : run_common<Motion> {
    Stepper given;
    run_dense(const bench_scene *of, const Stepper &stepper) : run_common<Motion>(of), given(stepper) {}
    bool run(const double *inputs, double *samples) override
    {
        Stepper stepper(given);
        bool is_first = true;
        return this->loop(inputs, samples, [&](int span, bool) {
            if (is_first) {
                stepper.initialize(this->x, 0.0, 1e-4);
                is_first = false;
            }
            const double end = (span + 1) * scene_span(this->scene);
            while (stepper.current_time() < end) {
                stepper.do_step(std::cref(this->motion));
            }
            stepper.calc_state(end, this->x);
            return true;
        });
    }
};

template <class Motion, class Stepper>
std::unique_ptr<run_base> adaptive(const bench_scene *scene, const Stepper &stepper)
{
    return std::make_unique<run_adaptive<Motion, Stepper>>(scene, stepper);
}

template <int N, rate_of *rate>
std::unique_ptr<run_base> make(const bench_scene *scene, int method, double setting)
{
    using M = motion<N, rate>;
    using state = typename M::state;
    using dopri5 = odeint::runge_kutta_dopri5<state>;
    using fehlberg78 = odeint::runge_kutta_fehlberg78<state>;
    switch (method) {
    case RK4: return std::make_unique<run_fixed<M, odeint::runge_kutta4<state>>>(scene, setting);
    case DOPRI5_FIXED: return std::make_unique<run_fixed<M, dopri5>>(scene, setting);
    case FEHLBERG78_FIXED: return std::make_unique<run_fixed<M, fehlberg78>>(scene, setting);
    case CASH_KARP54:
        return adaptive<M>(scene,
                           odeint::make_controlled<odeint::runge_kutta_cash_karp54<state>>(setting, setting));
    case DOPRI5: return adaptive<M>(scene, odeint::make_controlled<dopri5>(setting, setting));
    case FEHLBERG78: return adaptive<M>(scene, odeint::make_controlled<fehlberg78>(setting, setting));
    case BULIRSCH_STOER: return adaptive<M>(scene, odeint::bulirsch_stoer<state>(setting, setting));
    default: break;
    }
    if (scene->is_held) {
        return nullptr; // cut off at each tick: the same as without
    }
    auto dense = odeint::make_dense_output<dopri5>(setting, setting);
    return std::make_unique<run_dense<M, decltype(dense)>>(scene, dense);
}

const char *version()
{
    return BOOST_LIB_VERSION;
}

void *open_theirs(const bench_scene *scene, int method, double setting)
{
    switch (scene->form) {
    case SCENE_PENDULUM: return make<2, scene_pendulum_rate>(scene, method, setting).release();
    case SCENE_SPRING: return make<4, scene_spring_rate>(scene, method, setting).release();
    case SCENE_CART_POLE: return make<4, scene_cart_pole_rate>(scene, method, setting).release();
    case SCENE_WHEEL: return make<5, scene_wheel_rate>(scene, method, setting).release();
    case SCENE_BODY: return make<7, scene_body_rate>(scene, method, setting).release();
    }
    return nullptr;
}

bool run(void *self, const double *inputs, double *samples)
{
    try {
        return static_cast<run_base *>(self)->run(inputs, samples);
    } catch (const std::exception &) {
        return false; // a step of no length
    }
}

void close_theirs(void *self)
{
    delete static_cast<run_base *>(self);
}

} // namespace

extern "C" const peer the_peer = {"Boost.odeint", version, METHODS, methods, open_theirs, run, close_theirs};
