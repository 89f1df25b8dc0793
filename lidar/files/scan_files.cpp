#include "canyon/lidar/files/scan_files.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <type_traits>

#include "canyon/core/check.h"
#include "canyon/core/files/pcd.h"
#include "canyon/lidar/scanner.h"

namespace canyon::lidar {
namespace {

/// Appends numbers in little-endian order, whatever the machine's.
class Bytes {
 public:
  template <class T>
  Bytes& put(T value) {
    using Bits =
        std::conditional_t<sizeof(T) == 8, std::uint64_t,
                           std::conditional_t<sizeof(T) == 4, std::uint32_t,
                                              std::conditional_t<sizeof(T) == 2, std::uint16_t, std::uint8_t>>>;
    auto bits = std::bit_cast<Bits>(value);
    for (std::size_t i = 0; i < sizeof(T); ++i) text_.push_back(static_cast<char>((bits >> (8 * i)) & 0xff));
    return *this;
  }
  /// Padded with zeros to `size`.
  Bytes& put_text(std::string_view text, std::size_t size) {
    text_.append(text.substr(0, size));
    text_.append(size - std::min(size, text.size()), '\0');
    return *this;
  }
  std::string take() { return std::move(text_); }
  void reserve(std::size_t bytes) { text_.reserve(bytes); }
  explicit Bytes(std::string text = {}) : text_(std::move(text)) {}

 private:
  std::string text_;
};

void put_point(Bytes& out, const LidarPoint& p) {
  out.put(p.x).put(p.y).put(p.z).put(p.intensity).put(p.time_s).put(p.ring).put(p.return_index);
}

std::string pcd_text(GpsTime, std::span<const LidarPoint> points) {
  static const std::vector<PcdField> kFields{{.name = "x"},
                                             {.name = "y"},
                                             {.name = "z"},
                                             {.name = "intensity"},
                                             {.name = "time"},
                                             {.name = "ring", .type = 'U', .size = 2},
                                             {.name = "return", .type = 'U', .size = 1}};
  Bytes out(pcd_header(kFields, points.size()));
  for (const LidarPoint& p : points) put_point(out, p);
  return out.take();
}

std::string ply_text(GpsTime, std::span<const LidarPoint> points) {
  Bytes out("ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(points.size()) +
            "\nproperty float x\nproperty float y\nproperty float z\nproperty float intensity\nproperty float time\n"
            "property ushort ring\nproperty uchar return\nend_header\n");
  for (const LidarPoint& p : points) put_point(out, p);
  return out.take();
}

/// Returns of the shot that each point belongs to: neighbours of one laser and one time.
std::vector<std::uint8_t> returns_of_shot(std::span<const LidarPoint> points) {
  std::vector<std::uint8_t> out(points.size());
  for (std::size_t begin = 0; begin < points.size();) {
    std::size_t end = begin + 1;
    while (end < points.size() && points[end].ring == points[begin].ring &&
           points[end].time_s == points[begin].time_s && points[end].return_index > points[end - 1].return_index)
      ++end;
    std::fill(out.begin() + static_cast<std::ptrdiff_t>(begin), out.begin() + static_cast<std::ptrdiff_t>(end),
              static_cast<std::uint8_t>(end - begin));
    begin = end;
  }
  return out;
}

std::string las_text(GpsTime stamp, std::span<const LidarPoint> points) {
  constexpr double kScale_m = 1e-4;
  constexpr std::uint16_t kHeaderBytes = 227, kPointBytes = 28;
  const auto returns = returns_of_shot(points);
  std::array<std::uint32_t, 5> by_return{};
  std::array<double, 3> low{}, high{};
  const auto coordinate = [](const LidarPoint& p, std::size_t k) { return double{k == 0 ? p.x : k == 1 ? p.y : p.z}; };
  const auto whole = [](double metres) {
    CANYON_CHECK(std::abs(metres) < 2e5, "coordinate ", metres, " m");
    return static_cast<std::int32_t>(std::lround(metres / kScale_m));
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    ++by_return[std::min<std::size_t>(points[i].return_index, 4)];
    for (std::size_t k = 0; k < 3; ++k) {
      const double v = whole(coordinate(points[i], k)) * kScale_m;
      low[k] = i == 0 ? v : std::min(low[k], v);
      high[k] = i == 0 ? v : std::max(high[k], v);
    }
  }
  const CalendarTime date = calendar(stamp);
  Bytes out;
  out.put_text("LASF", 4).put(std::uint16_t{0}).put(std::uint16_t{1});  // GPS time is adjusted standard time
  out.put_text("", 16).put(std::uint8_t{1}).put(std::uint8_t{2});
  out.put_text("SIMULATION", 32).put_text("canyon", 32);
  out.put(static_cast<std::uint16_t>(stamp.day_of_year())).put(static_cast<std::uint16_t>(date.year));
  out.put(kHeaderBytes).put(std::uint32_t{kHeaderBytes}).put(std::uint32_t{0});
  out.put(std::uint8_t{1}).put(kPointBytes).put(static_cast<std::uint32_t>(points.size()));
  for (const std::uint32_t n : by_return) out.put(n);
  for (int k = 0; k < 3; ++k) out.put(kScale_m);
  for (int k = 0; k < 3; ++k) out.put(0.0);
  for (std::size_t k = 0; k < 3; ++k) out.put(high[k]).put(low[k]);
  const double stamp_s = static_cast<double>(stamp.ns / kNsPerSecond - 1'000'000'000) +
                         static_cast<double>(stamp.ns % kNsPerSecond) * 1e-9;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const LidarPoint& p = points[i];
    for (std::size_t k = 0; k < 3; ++k) out.put(whole(coordinate(p, k)));
    out.put(static_cast<std::uint16_t>(std::lround(65535.0 * std::clamp(p.intensity, 0.0f, 1.0f))));
    const unsigned number = std::min<unsigned>(p.return_index + 1u, 5u), count = std::min<unsigned>(returns[i], 5u);
    out.put(static_cast<std::uint8_t>(number | count << 3));
    out.put(std::uint8_t{0}).put(std::int8_t{0});  // never classified; no scan angle
    out.put(static_cast<std::uint8_t>(std::min<unsigned>(p.ring, 255u))).put(std::uint16_t{0});
    out.put(stamp_s + double{p.time_s});
  }
  return out.take();
}

}  // namespace

const std::vector<CloudFormat>& cloud_formats() {
  static const std::vector<CloudFormat> kRows{
      {"pcd", &pcd_text, "binary PCD 0.7"},
      {"ply", &ply_text, "binary PLY"},
      {"las", &las_text, "LAS 1.2, point format 1"},
  };
  return kRows;
}

Result<const CloudFormat*> cloud_format(const std::string& name, const std::string& option) {
  std::string known;
  for (const CloudFormat& row : cloud_formats()) {
    if (name == row.name) return &row;
    known += (known.empty() ? "" : ", ") + std::string(row.name);
  }
  return Error{option, 0, "", "unknown format \"" + name + '"', "one of " + known};
}

std::string truth_csv(std::span<const LidarPointTruth> truth, const scene::SceneAt& scene) {
  std::string out = "true_range_m,cos_incidence,material,object\n";
  const auto& materials = scene.scene().materials();
  for (const LidarPointTruth& t : truth) {
    std::array<char, 64> numbers;
    std::snprintf(numbers.data(), numbers.size(), "%.4f,%.5f,", t.range_m, t.cos_incidence);
    out += numbers.data();
    if (t.material != kNoMaterial) out += materials[t.material].name;
    out += ',';
    if (t.object != kNoObject) out += scene.object(t.object).name;
    out += '\n';
  }
  return out;
}

}  // namespace canyon::lidar
