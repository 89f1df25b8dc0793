#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "canyon/gnss/single_point/single_point.h"

namespace canyon::gnss {

/// Names of the files that a solution is made from; an empty name: no such file.
struct RecordedFiles {
  std::string observations;
  std::vector<std::string> navigation;
  std::vector<std::string> sp3;  ///< precise orbits and clocks instead of the broadcast ones
  std::string antex, ionex;
  std::string base{};                       ///< observations of a base
  std::optional<Eigen::Vector3d> base_E{};  ///< where its antenna is
};

/// What they hold.
struct RecordedData {
  NavigationData navigation;
  ObservationFile observations;
  /// By broadcast orbits and clocks; or by precise ones with the broadcast group delays and GLONASS's channels.
  std::unique_ptr<Constellation> constellation;
  std::optional<IonexMaps> ionosphere_maps;
  std::optional<BaseRecording> base;
  std::vector<std::string> warnings;  ///< of all files but the observations, which keep their own

  SinglePointInputs inputs() const {
    return {*constellation, navigation, ionosphere_maps ? &*ionosphere_maps : nullptr, base ? &*base : nullptr};
  }
};
Result<RecordedData> read_recorded_data(const RecordedFiles& files, const SinglePointConfig& config);

}  // namespace canyon::gnss
