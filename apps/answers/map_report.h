#pragma once

#include <optional>
#include <string>

#include "canyon/core/output/json.h"
#include "canyon/lidar/map_quality/map_report.h"
#include "canyon/lidar/map_quality/trajectory_error.h"

namespace canyon::apps {

/// What `canyon lidar evaluate` says.
struct MapAnswer {
  lidar::MapReport map;
  std::string completeness_of;  ///< what the true points are: "beams", "surfaces near the map"
  std::optional<lidar::TrajectoryErrors> trajectory;
  std::string alignment;
};

Json map_answer_json(const MapAnswer& answer);
std::string map_answer_text(const MapAnswer& answer);

}  // namespace canyon::apps
