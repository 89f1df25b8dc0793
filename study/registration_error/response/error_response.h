#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/files/tape.h"
#include "canyon/core/output/json.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/study/registration_error/events/event_average.h"
#include "canyon/study/registration_error/response/replayed_mapper.h"

namespace canyon::study {

struct ErrorResponseOptions {
  std::string fidelity = "high";
  std::vector<std::string> methods{"gicp", "point_to_plane", "none"};  ///< rows of lidar::registration_methods()
  std::vector<std::string> errors{};                                   ///< rows of estimate_errors(); none: all
  std::vector<double> sizes{};                                         ///< of all of them; none: each kind's own
  std::int64_t seeds = 1;                                              ///< the mission's own the first
  double stretch_m = 100.0;                                            ///< length of a place
  bool show_progress = true;
};

/// What comes of an error of one size: root mean squares over the keyframes, m.
struct ResponsePoint {
  double size = 0.0;
  double prior_m = kNaN, registered_m = kNaN;
  EstimatedNumber healed;   ///< 1 - registered / prior; below 0: registration makes it worse
  double unaligned = kNaN;  ///< share of the keyframes whose alignment gave nothing: there the prediction carries on
};

/// One kind of error along one axis, by its size, with one method: everywhere, or in one place.
struct ResponseCurve {
  std::string method, kind, axis;  ///< axis: empty where the kind has none
  std::optional<double> from_m;    ///< where the place begins on the route; none: all of them together
  std::vector<ResponsePoint> keyframe, map;
  EstimatedNumber keyframe_half, map_half;  ///< half_healed_size()
};

/// The method's own error where the estimate is the true pose.
struct UndisturbedError {
  std::string method;
  double keyframe_m = kNaN, map_m = kNaN, prior_map_m = kNaN;
};

struct ErrorResponse {
  std::string mission, fidelity, tape;
  std::int64_t seed = 0, seeds = 0;
  double stretch_m = 0.0;
  std::vector<double> places_from_m;
  std::vector<UndisturbedError> undisturbed;  ///< by method
  std::vector<ResponseCurve> curves;
  double cpu_s = 0.0;
};

/// How much registration takes away of errors of the estimate that places scans. Each seed is driven once over the
/// tape; its keyframes are then mapped again, stretch by stretch, with the true pose and an error laid on it
/// (estimate_errors.h), by the mission's own mapper with the covariances that the mission's filter claimed. Every
/// stretch begins with a map of its own, of as many undisturbed keyframes before it as a submap holds. Intervals: of
/// all places together places drawn anew, of one place seeds (cluster_bootstrap.h). Same bits for any number of
/// threads. An Error for an unknown method or kind, or a route without a place.
Result<ErrorResponse> measure_error_response(const mission::MissionConfig& config,
                                             const mission::PreparedMission& mission, const Tape& tape,
                                             const ErrorResponseOptions& options);
/// That methods and errors are known, before any time is spent.
Status check_response(const ErrorResponseOptions& options);

Json error_response_json(const ErrorResponse& response);
/// `method,kind,axis,from_m,size,series,prior_m,registered_m,healed,low,high,unaligned`; from_m is empty for all
/// places.
std::string error_response_csv(const ErrorResponse& response);
std::string error_response_table(const ErrorResponse& response);

}  // namespace canyon::study
