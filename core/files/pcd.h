#pragma once

#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/result.h"

/// Point clouds as PCD 0.7 (https://pointclouds.org/documentation/tutorials/pcd_file_format.html),
/// little-endian: the only place where the format is known.
namespace canyon {

/// A column of a cloud: one value of a point, or several that follow one another.
struct PcdField {
  std::string name;
  char type = 'F';         ///< F, I or U
  std::size_t size = 4;    ///< of a value, bytes: 1, 2, 4 or 8
  std::size_t count = 1;   ///< values
  std::size_t offset = 0;  ///< within a point's bytes; set by the reader
};

/// All that stands before the points: each is then the values of its fields, one after the other.
std::string pcd_header(const std::vector<PcdField>& fields, std::size_t points);

/// Reads a cloud piece by piece: memory does not grow with it. Text, compressed data, damaged headers and files that
/// end before their last point are errors; what stands behind the last point is passed over.
class PcdReader {
 public:
  static Result<PcdReader> open(const std::string& path);

  std::size_t points() const { return points_; }
  std::size_t point_bytes() const { return point_bytes_; }

  /// Where in a point's bytes the one number of type F and size 4 of that name is; error: none is, or two are.
  Result<std::size_t> float_at(const std::string& name) const;

  /// Whole points, a megabyte at most unless one point is more; empty after the last. Valid until the next call.
  Result<std::span<const char>> next();

 private:
  PcdReader() = default;

  std::string path_;
  std::ifstream in_;
  std::vector<PcdField> fields_;
  std::size_t point_bytes_ = 0, points_ = 0, done_ = 0;
  std::vector<char> bytes_;
};

/// x, y and z of all points of a cloud.
struct CloudPlaces {
  std::vector<Eigen::Vector3d> points;  ///< as the file has them: they may not be finite
  bool single_precision = false;        ///< that is how the file holds them
};
/// Reads a cloud of text, binary or compressed data (LZF) with any fields beside x, y and z, which may be of any type.
/// A file that ends before its last point, or is no PCD, is an error.
Result<CloudPlaces> read_pcd_places(const std::string& path);

}  // namespace canyon
