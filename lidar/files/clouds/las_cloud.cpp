// LAS 1.2 to 1.4 (ASPRS, LAS Specification 1.4-R15): the public header block and the first 12 bytes of each point.
#include <cstring>

#include "canyon/lidar/files/clouds/read_cloud.h"

namespace canyon::lidar {
namespace {

template <class T>
T number_at(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace

Result<CloudPlaces> read_las_cloud(const std::string& path, const std::string& bytes) {
  constexpr std::size_t kHeader12 = 227, kHeader14 = 375;
  if (bytes.size() < kHeader12) return Error{path, 0, "", "ends within the header", "a LAS file"};
  const int major = bytes[24], minor = bytes[25];
  if (major != 1 || minor < 2 || minor > 4)
    return Error{path, 0, "", "is LAS " + std::to_string(major) + "." + std::to_string(minor), "LAS 1.2 to 1.4"};
  if (minor == 4 && bytes.size() < kHeader14) return Error{path, 0, "", "ends within the header", "a LAS file"};
  const auto format = static_cast<unsigned char>(bytes[104]);
  if (format > 10)
    return Error{path, 0, "", "holds points of format " + std::to_string(format), "0 to 10, not compressed"};
  const std::uint64_t begin = number_at<std::uint32_t>(bytes, 96);
  const std::uint64_t record = number_at<std::uint16_t>(bytes, 105);
  const std::uint64_t count = minor == 4 ? number_at<std::uint64_t>(bytes, 247) : number_at<std::uint32_t>(bytes, 107);
  if (record < 20 || begin < kHeader12)
    return Error{path, 0, "", "has points of " + std::to_string(record) + " bytes at " + std::to_string(begin),
                 "at least 20 bytes, after the header"};
  if (begin > bytes.size() || (bytes.size() - begin) / record < count)
    return Error{
        path, 0, "",
        "the file holds " + std::to_string(begin > bytes.size() ? 0 : (bytes.size() - begin) / record) + " points",
        std::to_string(count) + " as its header says"};
  double scale[3], offset[3];
  std::memcpy(scale, bytes.data() + 131, sizeof scale);
  std::memcpy(offset, bytes.data() + 155, sizeof offset);
  CloudPlaces out;
  out.points.resize(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    for (std::size_t a = 0; a < 3; ++a)
      out.points[i][static_cast<Eigen::Index>(a)] =
          offset[a] + scale[a] * number_at<std::int32_t>(bytes, begin + i * record + 4 * a);
  }
  return out;
}

}  // namespace canyon::lidar
