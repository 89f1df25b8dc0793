#pragma once

#include <string>

#include "canyon/core/files/pcd.h"
#include "canyon/core/result.h"

namespace canyon::lidar {

/// Points of a cloud file, m, in its own frame: PCD (text, binary, compressed), PLY (text, binary of either order), LAS
/// 1.2 to 1.4, .bin (records of x, y, z, intensity as 4-byte floats, as KITTI has them), a Velodyne capture (.pcap,
/// VLP-16 and HDL-32E) or an Ouster one whose JSON lies beside it (ouster::metadata_path()); of captures the first
/// whole revolution, not deskewed. PCD, PLY, LAS and captures are known by how they begin, .bin by its name. A file
/// that is empty, damaged, of no known form or without a point is an error.
Result<CloudPlaces> read_cloud(const std::string& path);

// The formats, each in its own file.
Result<CloudPlaces> read_ply_cloud(const std::string& path, const std::string& bytes);
Result<CloudPlaces> read_las_cloud(const std::string& path, const std::string& bytes);
Result<CloudPlaces> read_bin_cloud(const std::string& path, const std::string& bytes);
Result<CloudPlaces> read_capture_cloud(const std::string& path);
Result<CloudPlaces> read_ouster_cloud(const std::string& path, const std::string& metadata_path);

}  // namespace canyon::lidar
