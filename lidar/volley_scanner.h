#pragma once

#include <cstdint>
#include <memory>

#include "canyon/lidar/beam/beam_table.h"
#include "canyon/lidar/beam/echo_model.h"
#include "canyon/lidar/receiver/detector.h"
#include "canyon/lidar/scanner.h"

namespace canyon::lidar {

/// The scanner: volley by volley through the chain of its models, volleys side by side on all threads.
std::unique_ptr<Scanner> make_volley_scanner(const LidarConfig& config, BeamTable table,
                                             std::unique_ptr<EchoModel> model, std::unique_ptr<Detector> detector,
                                             std::uint64_t seed);

}  // namespace canyon::lidar
