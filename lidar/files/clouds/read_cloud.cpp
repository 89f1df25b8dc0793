#include "canyon/lidar/files/clouds/read_cloud.h"

#include <algorithm>
#include <cstring>

#include "canyon/core/files/files.h"
#include "canyon/lidar/ouster/recording.h"
#include "canyon/lidar/velodyne/packet.h"
#include "canyon/lidar/velodyne/packet_reader.h"
#include "canyon/lidar/velodyne/pcap.h"

namespace canyon::lidar {
namespace {

bool is_capture(std::string_view bytes) {
  for (const char* magic : {"\xd4\xc3\xb2\xa1", "\xa1\xb2\xc3\xd4", "\x4d\x3c\xb2\xa1", "\xa1\xb2\x3c\x4d"})
    if (bytes.starts_with(std::string_view(magic, 4))) return true;
  return false;
}

bool is_pcd(std::string_view bytes) {
  return bytes.starts_with("# .PCD") || bytes.starts_with("VERSION") || bytes.starts_with("FIELDS");
}

Result<CloudPlaces> read_known(const std::string& path, const std::string& bytes) {
  if (is_pcd(bytes)) return read_pcd_places(path);
  if (bytes.starts_with("ply")) return read_ply_cloud(path, bytes);
  if (bytes.starts_with("LASF")) return read_las_cloud(path, bytes);
  if (is_capture(bytes)) return read_capture_cloud(path);
  if (path.ends_with(".bin")) return read_bin_cloud(path, bytes);
  return Error{path, 0, "", "is no cloud of a known form",
               "PCD, PLY, LAS, .bin or a capture of a Velodyne or Ouster sensor"};
}

}  // namespace

Result<CloudPlaces> read_cloud(const std::string& path) {
  CANYON_TRY(const std::string bytes, read_text_file(path));
  if (bytes.empty()) return Error{path, 0, "", "is empty", "a cloud of points"};
  CANYON_TRY(CloudPlaces cloud, read_known(path, bytes));
  if (cloud.points.empty()) return Error{path, 0, "", "holds no points", "a cloud of points"};
  return cloud;
}

Result<CloudPlaces> read_bin_cloud(const std::string& path, const std::string& bytes) {
  constexpr std::size_t kRecord = 4 * sizeof(float);
  if (bytes.size() % kRecord != 0)
    return Error{path, 0, "", "is " + std::to_string(bytes.size()) + " bytes long",
                 "records of 16: x, y, z, intensity"};
  CloudPlaces out;
  out.single_precision = true;
  for (std::size_t at = 0; at < bytes.size(); at += kRecord) {
    float p[3];
    std::memcpy(p, bytes.data() + at, sizeof p);
    out.points.emplace_back(p[0], p[1], p[2]);
  }
  return out;
}

Result<CloudPlaces> read_capture_cloud(const std::string& path) {
  if (const std::string metadata = ouster::metadata_path(path); !metadata.empty())
    return read_ouster_cloud(path, metadata);
  CANYON_TRY(const velodyne::Capture capture, velodyne::read_pcap(path));
  if (!capture.warning.empty()) return Error{path, 0, "", capture.warning, "a whole capture"};
  CloudPlaces out;
  double turned_deg = 0.0, last_deg = -1.0;
  for (const auto& datagram : capture.datagrams) {
    const auto packet = velodyne::Packet::parse(datagram.payload);
    if (!packet) continue;
    CANYON_TRY(const BeamTable table, load_beam_table(velodyne::beam_table_of(packet->product)));
    for (const auto& block : packet->blocks) {
      const double azimuth_deg = 0.01 * block.azimuth_cdeg;
      if (last_deg >= 0.0) turned_deg += azimuth_deg - last_deg + (azimuth_deg < last_deg ? 360.0 : 0.0);
      last_deg = azimuth_deg;
    }
    for (const auto& r : velodyne::decode(*packet, table)) out.points.emplace_back(r.point.x, r.point.y, r.point.z);
    if (turned_deg >= 360.0) break;
  }
  if (out.points.empty())
    return Error{path, 0, "", "holds no return of a sensor that is known",
                 "packets of a VLP-16 or HDL-32E, or of an Ouster sensor with its JSON beside"};
  return out;
}

}  // namespace canyon::lidar
