#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/result.h"
#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/gnss/sensor/sensor.h"
#include "canyon/study/reproduce/parts.h"

/// The receiver of the paper's field tests: an open place near Vicksburg, one frequency, seven satellites.
namespace canyon::study {

/// No error acts and nothing is corrected: rows and solver are the caller's to name. No path but the direct one, no
/// noise, no clock error, equal weights as in "a generic trilateration algorithm"; the mask leaves seven satellites at
/// the paper's time, as many as it had.
gnss::GnssConfig error_free_receiver(const PaperSky& sky, const char* mode, const char* solver);

/// A drive or a stay, as the antenna's place in W after a time.
struct PaperWay {
  double seconds, rate_hz;
  std::function<Eigen::Vector3d(double)> p_W;
};
/// One output per epoch, in order. Errors: navigation data that does not cover it.
Result<std::vector<gnss::GnssOutput>> measured(const gnss::GnssConfig& config, std::uint64_t seed, GpsTime start,
                                               const PaperWay& way);

}  // namespace canyon::study
