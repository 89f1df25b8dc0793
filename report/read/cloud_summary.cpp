#include "canyon/report/read/cloud_summary.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>

#include "canyon/core/process/progress.h"
#include "canyon/report/read/number_limit.h"

namespace canyon::report {
namespace {

/// What the header of a PCD says that matters here.
struct PcdHeader {
  std::size_t point_size = 0;
  std::size_t x_at = 0, y_at = 0, error_at = 0;
  std::uint64_t points = 0;
};

struct PcdField {
  std::string name;
  std::size_t size = 0, count = 1;
  char type = 'F';
};

bool parse_whole(const std::string& word, std::uint64_t& value) {
  const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
  return status == std::errc{} && end == word.data() + word.size();
}

Result<PcdHeader> read_header(std::istream& in, const std::string& path) {
  std::vector<PcdField> fields;
  std::optional<std::uint64_t> points;
  std::string line;
  constexpr int kMaxHeaderLines = 64;
  for (int number = 1; number <= kMaxHeaderLines && std::getline(in, line); ++number) {
    std::istringstream words(line);
    std::string key, word;
    words >> key;
    std::vector<std::string> values;
    while (words >> word) values.push_back(word);
    const auto mistake = [&](std::string what, std::string expected) {
      return Error{path, number, key, what, expected};
    };

    if (key == "FIELDS") {
      for (const std::string& name : values) fields.push_back({.name = name});
    } else if (key == "SIZE" || key == "COUNT" || key == "TYPE") {
      if (values.size() != fields.size()) {
        return mistake(std::to_string(values.size()) + " values", std::to_string(fields.size()) + ", one per field");
      }
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (key == "TYPE") {
          fields[i].type = values[i][0];
          continue;
        }
        std::uint64_t n = 0;
        if (!parse_whole(values[i], n) || n == 0 || n > 4096)
          return mistake("'" + values[i] + "'", "a small positive integer");
        (key == "SIZE" ? fields[i].size : fields[i].count) = n;
      }
    } else if (key == "POINTS") {
      std::uint64_t n = 0;
      if (values.size() != 1 || !parse_whole(values[0], n)) return mistake("not a number of points", "one integer");
      points = n;
    } else if (key == "DATA") {
      if (values != std::vector<std::string>{"binary"})
        return mistake("'" + (values.empty() ? "" : values[0]) + "'", "'binary'");
      if (!points) return Error{path, number, "POINTS", "missing", "the number of points"};
      PcdHeader header;
      header.points = *points;
      std::size_t found = 0;
      for (const PcdField& field : fields) {
        std::size_t* at = field.name == "x"       ? &header.x_at
                          : field.name == "y"     ? &header.y_at
                          : field.name == "error" ? &header.error_at
                                                  : nullptr;
        if (at && field.size == 4 && field.type == 'F' && field.count == 1) {
          *at = header.point_size;
          ++found;
        }
        header.point_size += field.size * field.count;
      }
      if (found != 3) return Error{path, 0, "FIELDS", "no float32 x, y and error", "fields x y z intensity error"};
      return header;
    }
  }
  return Error{path, 0, "DATA", "missing", "a PCD header"};
}

float float_at(const char* bytes) {
  float value = 0;
  std::memcpy(&value, bytes, sizeof value);  // PCD binary is little-endian, as every platform we build for
  return value;
}

std::size_t bin_of(double error_m) {
  if (!(error_m >= ErrorBins::kMin_m)) return 0;
  if (error_m >= ErrorBins::kMax_m) return ErrorBins::kCount + 1;
  const double place = std::log10(error_m / ErrorBins::kMin_m) * ErrorBins::kPerDecade;
  return 1 + std::min(static_cast<std::size_t>(place), ErrorBins::kCount - 1);
}

}  // namespace

MapGrid MapGrid::over(const Eigen::Vector2d& min_W, const Eigen::Vector2d& max_W, std::size_t cells) {
  const Eigen::Vector2d size_m = max_W - min_W;
  CANYON_CHECK(size_m.minCoeff() > 0 && cells > 0, "size ", size_m.x(), " x ", size_m.y(), ", cells ", cells);
  MapGrid grid;
  grid.min_W = min_W;
  grid.cell_m = size_m.maxCoeff() / static_cast<double>(cells);
  grid.columns = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(size_m.x() / grid.cell_m - 1e-9)));
  grid.rows = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(size_m.y() / grid.cell_m - 1e-9)));
  return grid;
}

double ErrorBins::edge_m(std::size_t i) {
  return kMin_m * std::pow(10.0, static_cast<double>(i) / static_cast<double>(kPerDecade));
}

double CloudSummary::rms_m() const {
  return points ? std::sqrt(sum_squares_m2 / static_cast<double>(points)) : std::nan("");
}

double CloudSummary::share_below_edge(std::size_t i) const {
  if (points == 0) return std::nan("");
  std::uint64_t below = 0;
  for (std::size_t bin = 0; bin <= i; ++bin) below += histogram[bin];
  return static_cast<double>(below) / static_cast<double>(points);
}

double CloudSummary::quantile_m(double share) const {
  if (points == 0) return std::nan("");
  const double wanted = share * static_cast<double>(points);
  double below = 0;
  for (std::size_t bin = 0; bin < histogram.size(); ++bin) {
    const auto here = static_cast<double>(histogram[bin]);
    if (below + here >= wanted && here > 0) {
      if (bin == 0) return ErrorBins::kMin_m;
      if (bin == ErrorBins::kCount + 1) return max_m;
      const double low = std::log(ErrorBins::edge_m(bin - 1));
      const double high = std::log(ErrorBins::edge_m(bin));
      return std::exp(low + (high - low) * (wanted - below) / here);
    }
    below += here;
  }
  return max_m;
}

Result<CloudSummary> summarize_cloud(const std::string& path, const MapGrid& grid) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return Error{path, 0, {}, "cannot be read", "a PCD file"};
  CANYON_TRY(const PcdHeader header, read_header(in, path));

  CloudSummary cloud;
  cloud.histogram.assign(ErrorBins::kCount + 2, 0);
  cloud.cell_rms_m.assign(grid.columns * grid.rows, 0.0f);
  std::vector<std::uint32_t> counts(cloud.cell_rms_m.size(), 0);
  constexpr std::size_t kPointsAtOnce = 65536;
  std::vector<char> bytes(kPointsAtOnce * header.point_size);
  for (std::uint64_t done = 0; done < header.points;) {
    throw_if_cancelled();
    const std::size_t n = static_cast<std::size_t>(std::min<std::uint64_t>(kPointsAtOnce, header.points - done));
    in.read(bytes.data(), static_cast<std::streamsize>(n * header.point_size));
    if (static_cast<std::size_t>(in.gcount()) != n * header.point_size) {
      const std::uint64_t whole = done + static_cast<std::size_t>(in.gcount()) / header.point_size;
      return Error{path, 0, "POINTS", "the file holds " + std::to_string(whole) + " points",
                   std::to_string(header.points) + " as its header says"};
    }
    for (std::size_t i = 0; i < n; ++i) {
      const char* point = bytes.data() + i * header.point_size;
      const float x = float_at(point + header.x_at), y = float_at(point + header.y_at);
      const float error_m = float_at(point + header.error_at);
      const auto defined = [](float value) { return std::abs(double{value}) <= kLargestNumber; };  // false for NaN
      if (!defined(x) || !defined(y) || !(error_m >= 0) || !defined(error_m)) {
        ++cloud.undefined;
        continue;
      }
      ++cloud.points;
      const double square_m2 = double{error_m} * double{error_m};
      cloud.sum_squares_m2 += square_m2;
      if (error_m > cloud.max_m) cloud.at_max = 0;
      cloud.max_m = std::max(cloud.max_m, double{error_m});
      if (error_m == cloud.max_m) ++cloud.at_max;
      ++cloud.histogram[bin_of(error_m)];
      const double column = std::floor((x - grid.min_W.x()) / grid.cell_m);
      const double row = static_cast<double>(grid.rows) - 1 - std::floor((y - grid.min_W.y()) / grid.cell_m);
      if (column < 0 || row < 0 || column >= static_cast<double>(grid.columns) ||
          row >= static_cast<double>(grid.rows)) {
        ++cloud.outside;
        continue;
      }
      const std::size_t cell = static_cast<std::size_t>(row) * grid.columns + static_cast<std::size_t>(column);
      cloud.cell_rms_m[cell] += static_cast<float>(square_m2);
      ++counts[cell];
    }
    done += n;
  }
  for (std::size_t i = 0; i < counts.size(); ++i) {
    cloud.cell_rms_m[i] = counts[i] ? std::sqrt(cloud.cell_rms_m[i] / static_cast<float>(counts[i])) : -1.0f;
  }
  return cloud;
}

}  // namespace canyon::report
