#pragma once

#include <cstdint>
#include <memory>

#include "lidar/beam_table.h"
#include "lidar/detector.h"
#include "lidar/echo_model.h"
#include "lidar/return_choice.h"
#include "lidar/scanner.h"

namespace canyon::lidar {

/// The scanner: volley by volley through the chain of its models, volleys side by side on all threads.
std::unique_ptr<Scanner> make_volley_scanner(const LidarConfig& config, BeamTable table,
                                             std::unique_ptr<EchoModel> model, std::unique_ptr<Detector> detector,
                                             ReturnMode returns, std::uint64_t seed);

}  // namespace canyon::lidar
