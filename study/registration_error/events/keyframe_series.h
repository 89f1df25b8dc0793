#pragma once

#include <array>
#include <optional>
#include <vector>

#include "canyon/mission/recorder/recorder.h"
#include "canyon/scene/scene.h"
#include "canyon/study/causes/events.h"
#include "canyon/study/registration_error/events/estimate_jumps.h"

namespace canyon::study {

/// What of a keyframe is followed, all in m: how far off it is, and how far its scan lies from the true surfaces where
/// it is put (scan_error.h), with the filter's pose and with the registered one.
inline constexpr std::array<const char*, 4> kErrorSeries{"keyframe_prior", "keyframe_registered", "map_prior",
                                                         "map_registered"};
using KeyframeErrors = std::array<double, kErrorSeries.size()>;

/// One run on the tape, as the events are held against it.
struct ErrorSeries {
  std::vector<double> t_s;  ///< of the keyframes, after the start, ascending
  std::vector<KeyframeErrors> errors;
  std::vector<MapEvent> events;

  /// Error `series` at t_s, linear between two keyframes; NaN where they are over kLongestGap_s apart, as where the
  /// vehicle stands: nothing is mapped there.
  double at(std::size_t series, double t_s) const;
  static constexpr double kLongestGap_s = 3.0;
};

/// Makes it of a run as it goes. Without registration the registered errors are NaN. `scene` must outlive it.
class SeriesRecorder final : public mission::Recorder {
 public:
  SeriesRecorder(const scene::Scene& scene, GpsTime start, double map_range_m, double gnss_rate_hz, bool registers)
      : scene_(scene),
        start_(start),
        map_range_m_(map_range_m),
        gnss_period_s_(1.0 / gnss_rate_hz),
        registers_(registers) {}

  Status gnss(const mission::GnssRow& row) override;
  Status keyframe(const mission::KeyframeRow& row) override;
  Status keyframe_input(const mission::KeyframeInput& input) override;

  /// Once the run has ended.
  ErrorSeries take();

 private:
  const scene::Scene& scene_;
  GpsTime start_;
  double map_range_m_, gnss_period_s_;
  bool registers_;
  std::optional<double> first_fix_s_;
  double last_fix_s_ = 0.0;  ///< both after the start
  RunEvents fixes_;
  EstimateJumps jumps_;
  Pose X_WL_prior_, X_WL_registered_;  ///< of the keyframe whose input follows
  ErrorSeries series_;
};

}  // namespace canyon::study
