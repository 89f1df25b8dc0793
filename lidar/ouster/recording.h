#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/result.h"

namespace canyon::lidar::ouster {

/// What the sensor says of itself, in the JSON that goes with a recording.
struct Metadata {
  int columns_per_frame = 0, columns_per_packet = 0;
  std::vector<double> elevation_deg, azimuth_deg;  ///< by pixel of a column; azimuths from the head's direction
  double origin_out_m = 0.0;                       ///< how far from the axis a beam begins
  Eigen::Matrix4d lidar_to_sensor = Eigen::Matrix4d::Identity();  ///< m
};
/// Errors: no JSON, a figure missing or of another size, a profile of packets other than the low-bandwidth one
/// (RNG15_RFL8_NIR8).
Result<Metadata> read_metadata(const std::string& path);

/// A return. The frame is the sensor's: x ahead (away from the plug), z up, the origin in the middle of its base.
struct Return {
  Eigen::Vector3d p_m;
  double range_m = 0.0;  ///< as the packet has it, from the axis along the beam
  int pixel = 0, column = 0;
  int reflectivity = 0;   ///< 0 to 255, calibrated: to 100 linear in per cent, above logarithmic
  std::int64_t t_ns = 0;  ///< of its column, by the sensor's clock
};
/// One turn of the head.
struct Frame {
  int id = 0;
  int columns = 0;  ///< that arrived and are said to be good
  std::vector<Return> returns;
};

/// The frames of a capture, in the order of their first packets. Packets of another size, as the inertial unit's, are
/// left out. Errors: as of read_pcap(), a capture cut off, one without a packet of such a sensor.
Result<std::vector<Frame>> read_frames(const std::string& path, const Metadata& metadata);

/// The metadata that goes with a capture: "a_b_c.pcap" has "a_b_c.json", else "a_b.json", else "a.json", of those that
/// tell of such a sensor; "" where none is there.
std::string metadata_path(const std::string& capture_path);

}  // namespace canyon::lidar::ouster
