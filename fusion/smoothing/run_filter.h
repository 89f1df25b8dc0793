#pragma once

#include <algorithm>
#include <functional>
#include <span>

#include "canyon/core/result.h"
#include "canyon/fusion/error_state_filter.h"
#include "canyon/fusion/smoothing/smoother.h"

namespace canyon::fusion {

/// Samples of the run from its start on; an Error names the first that does not follow the one before.
Result<std::span<const ImuSample>> samples_of(const SmootherInput& run);

/// The filter of the run, at its start.
ErrorStateFilter started_filter(const SmootherInput& run);

/// Messages of one kind, which come with the sample whose end is nearest.
template <class Message>
class Queue {
 public:
  explicit Queue(std::span<const Message> all) : rest_(all) {}
  /// Those that come with sample k, after those that came before it: nearer to its end than to that of the next.
  std::span<const Message> with(std::span<const ImuSample> samples, std::size_t k) {
    const double reach_s = 0.5 * samples[std::min(k + 1, samples.size() - 1)].dt_s;
    std::size_t count = 0;
    while (count < rest_.size() && rest_[count].t - samples[k].t <= reach_s) ++count;
    const auto out = rest_.first(count);
    rest_ = rest_.subspan(count);
    return out;
  }
  /// Forgets those that come before the first sample does.
  void begin(const ImuSample& first) {
    std::size_t count = 0;
    while (count < rest_.size() && rest_[count].t - (first.t - first.dt_s) < -0.5 * first.dt_s) ++count;
    rest_ = rest_.subspan(count);
  }

 private:
  std::span<const Message> rest_;
};

/// Runs the filter over the samples; `after` is called after each, with all that came with it.
void run_filter(const SmootherInput& run, std::span<const ImuSample> samples, ErrorStateFilter& filter,
                const std::function<void(const ImuSample&)>& after);

}  // namespace canyon::fusion
