// Packets and geometry: Ouster's sensor documentation, "Sensor Data" (static.ouster.dev/sensor-docs), sections
// "Coordinate Frames and XYZ Calculation" and "RNG15_RFL8_NIR8 Return Profile". Offsets and bits are as remembered of
// it; a recording confirms them: its packets' size to the byte, level ground, and scans that register onto one another.
#include "canyon/lidar/ouster/recording.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/units.h"
#include "canyon/lidar/velodyne/pcap.h"

namespace canyon::lidar::ouster {
namespace {

constexpr std::size_t kPacketHeader = 32, kPacketFooter = 32, kColumnHeader = 12, kPixel = 4;
constexpr double kRangeStep_m = 0.008;

/// In whatever section it stands: firmware and recorders differ in these, and in whether there are any.
const nlohmann::json* find(const nlohmann::json& document, const char* key) {
  if (!document.is_object()) return nullptr;
  if (document.contains(key)) return &document[key];
  for (const nlohmann::json& section : document)
    if (section.is_object() && section.contains(key)) return &section[key];
  return nullptr;
}

bool numbers(const nlohmann::json* list, std::vector<double>& out) {
  if (list == nullptr || !list->is_array()) return false;
  for (const nlohmann::json& value : *list) {
    if (!value.is_number()) return false;
    out.push_back(value.get<double>());
  }
  return true;
}

std::uint64_t number(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = count; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// Where a beam of a column meets what is `range_m` off.
class Geometry {
 public:
  explicit Geometry(const Metadata& metadata) : metadata_(metadata) {
    for (std::size_t i = 0; i < metadata.elevation_deg.size(); ++i) {
      const double up = metadata.elevation_deg[i] * kDegree;
      sines_.push_back(std::sin(up));
      cosines_.push_back(std::cos(up));
    }
  }
  Eigen::Vector3d place(std::size_t pixel, int column, double range_m) const {
    // Columns count clockwise seen from above, angles the other way.
    const double head = kTwoPi * (1.0 - static_cast<double>(column) / metadata_.columns_per_frame);
    const double beam = head - metadata_.azimuth_deg[pixel] * kDegree;
    const double n = metadata_.origin_out_m, along_m = range_m - n;
    const Eigen::Vector4d p(along_m * std::cos(beam) * cosines_[pixel] + n * std::cos(head),
                            along_m * std::sin(beam) * cosines_[pixel] + n * std::sin(head), along_m * sines_[pixel],
                            1.0);
    return (metadata_.lidar_to_sensor * p).head<3>();
  }

 private:
  static constexpr double kTwoPi = 2.0 * kPi;
  const Metadata& metadata_;
  std::vector<double> sines_, cosines_;
};

}  // namespace

Result<Metadata> read_metadata(const std::string& path) {
  CANYON_TRY(const std::string text, read_text_file(path));
  CANYON_TRY(const nlohmann::json document, parse_json(text, path));
  const auto missing = [&path](const char* key, const char* expected) {
    return Error{path, 0, key, "is missing or wrong", expected};
  };
  Metadata out;
  if (const auto* profile = find(document, "udp_profile_lidar"); profile == nullptr || *profile != "RNG15_RFL8_NIR8")
    return missing("udp_profile_lidar", "\"RNG15_RFL8_NIR8\", the low-bandwidth profile");
  const auto count = [&document](const char* key, int most) {
    const auto* value = find(document, key);
    const bool good = value != nullptr && value->is_number_integer() && *value >= 1 && *value <= most;
    return good ? value->get<int>() : 0;
  };
  out.columns_per_frame = count("columns_per_frame", 4096);
  if (out.columns_per_frame == 0) return missing("columns_per_frame", "a number of columns");
  out.columns_per_packet = count("columns_per_packet", 64);
  if (out.columns_per_packet == 0) return missing("columns_per_packet", "a number of columns");
  const auto pixels = static_cast<std::size_t>(count("pixels_per_column", 256));
  if (pixels == 0) return missing("pixels_per_column", "a number of pixels");
  if (!numbers(find(document, "beam_altitude_angles"), out.elevation_deg) || out.elevation_deg.size() != pixels)
    return missing("beam_altitude_angles", "degrees, one for each pixel of a column");
  if (!numbers(find(document, "beam_azimuth_angles"), out.azimuth_deg) || out.azimuth_deg.size() != pixels)
    return missing("beam_azimuth_angles", "degrees, one for each pixel of a column");
  const auto* out_mm = find(document, "lidar_origin_to_beam_origin_mm");
  if (out_mm == nullptr || !out_mm->is_number()) return missing("lidar_origin_to_beam_origin_mm", "millimetres");
  out.origin_out_m = 1e-3 * out_mm->get<double>();
  std::vector<double> T;
  if (!numbers(find(document, "lidar_to_sensor_transform"), T) || T.size() != 16)
    return missing("lidar_to_sensor_transform", "16 numbers, millimetres");
  for (int i = 0; i < 16; ++i)
    out.lidar_to_sensor(i / 4, i % 4) = T[static_cast<std::size_t>(i)] * (i % 4 == 3 && i < 12 ? 1e-3 : 1.0);
  return out;
}

Result<std::vector<Frame>> read_frames(const std::string& path, const Metadata& metadata) {
  CANYON_TRY(const velodyne::Capture capture, velodyne::read_pcap(path));
  if (!capture.warning.empty()) return Error{path, 0, "", capture.warning, "a whole capture"};
  const std::size_t pixels = metadata.elevation_deg.size(), column_bytes = kColumnHeader + kPixel * pixels;
  const auto columns = static_cast<std::size_t>(metadata.columns_per_packet);
  const std::size_t packet_bytes = kPacketHeader + columns * column_bytes + kPacketFooter;
  const Geometry geometry(metadata);
  std::vector<Frame> frames;
  for (const velodyne::Datagram& datagram : capture.datagrams) {
    const std::string_view bytes = datagram.payload;
    if (bytes.size() != packet_bytes) continue;
    const int id = static_cast<int>(number(bytes, 2, 2));
    // Among the last few: the number begins anew after 65535.
    constexpr std::ptrdiff_t kMixed = 4;
    const auto recent = frames.end() - std::min<std::ptrdiff_t>(kMixed, std::ssize(frames));
    auto frame = std::find_if(recent, frames.end(), [id](const Frame& f) { return f.id == id; });
    if (frame == frames.end()) frame = frames.insert(frames.end(), Frame{.id = id, .columns = 0, .returns = {}});
    for (std::size_t k = 0; k < columns; ++k) {
      const std::size_t at = kPacketHeader + k * column_bytes;
      const int column = static_cast<int>(number(bytes, at + 8, 2));
      if ((number(bytes, at + 10, 2) & 1) == 0 || column >= metadata.columns_per_frame) continue;
      ++frame->columns;
      for (std::size_t i = 0; i < pixels; ++i) {
        const std::size_t pixel = at + kColumnHeader + i * kPixel;
        const double range_m = kRangeStep_m * static_cast<double>(number(bytes, pixel, 2) & 0x7fff);
        if (range_m == 0.0) continue;
        frame->returns.push_back({.p_m = geometry.place(i, column, range_m),
                                  .range_m = range_m,
                                  .pixel = static_cast<int>(i),
                                  .column = column,
                                  .reflectivity = static_cast<int>(number(bytes, pixel + 2, 1)),
                                  .t_ns = static_cast<std::int64_t>(number(bytes, at, 8))});
      }
    }
  }
  if (frames.empty())
    return Error{path, 0, "", "holds no packet of " + std::to_string(packet_bytes) + " bytes",
                 "packets as its metadata describes them"};
  return frames;
}

std::string metadata_path(const std::string& capture_path) {
  const std::filesystem::path capture(capture_path);
  std::string stem = capture.stem().string();
  while (true) {
    const std::filesystem::path candidate = capture.parent_path() / (stem + ".json");
    // There may be a JSON of something else.
    const auto text = read_text_file(candidate.string());
    if (text && text->find("beam_altitude_angles") != std::string::npos) return candidate.string();
    const std::size_t end = stem.rfind('_');
    if (end == std::string::npos) return "";
    stem.resize(end);
  }
}

}  // namespace canyon::lidar::ouster
