#include <algorithm>

#include "canyon/fusion/smoothing/rts_smoother.h"
#include "canyon/fusion/smoothing/run_filter.h"
#include "canyon/fusion/smoothing/smoother.h"

namespace canyon::fusion {
namespace {

struct ForwardBackwardParameters {
  double smoothed_interval_s = 0.1;
};
void visit(FieldVisitor& f, ForwardBackwardParameters& p) {
  f.number("smoothed_interval_s", p.smoothed_interval_s, {0, 1e6},
           "between smoothed states of the filter; 0: at every IMU sample");
}

/// The filter forwards, and backwards over what it did; or forwards alone.
class ForwardBackward final : public Smoother {
 public:
  ForwardBackward(const ForwardBackwardParameters& p, bool backwards) : p_(p), backwards_(backwards) {}

  Result<Smoothed> smooth(const SmootherInput& run) override {
    CANYON_TRY(const auto samples, samples_of(run));
    ErrorStateFilter filter = started_filter(run);
    RtsSmoother recorder;
    Smoothed out;
    if (backwards_) filter.watch(&recorder);
    GpsTime due = run.start;
    run_filter(run, samples, filter, [&](const ImuSample& imu) {
      if (due - imu.t > 0.5 * imu.dt_s) return;
      due = due + std::max(p_.smoothed_interval_s, imu.dt_s);
      if (backwards_)
        recorder.keep(filter);
      else
        out.states.push_back(RtsSmoother::filtered(filter));
    });
    if (backwards_) out.states = recorder.smooth();
    return out;
  }

 private:
  ForwardBackwardParameters p_;
  bool backwards_;
};

}  // namespace

std::unique_ptr<Smoother> make_filter_alone(const ModelParameters& own) {
  return std::make_unique<ForwardBackward>(own.get<ForwardBackwardParameters>(), false);
}

std::unique_ptr<Smoother> make_rts(const ModelParameters& own) {
  return std::make_unique<ForwardBackward>(own.get<ForwardBackwardParameters>(), true);
}

void forward_backward_parameters(ModelParameters& section) {
  section.add<ForwardBackwardParameters>();
}

}  // namespace canyon::fusion
