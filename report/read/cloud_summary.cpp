#include "canyon/report/read/cloud_summary.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "canyon/core/files/pcd.h"
#include "canyon/core/process/progress.h"
#include "canyon/report/read/number_limit.h"

namespace canyon::report {
namespace {

float float_at(const char* bytes) {
  float value = 0;
  std::memcpy(&value, bytes, sizeof value);
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
  CANYON_TRY(PcdReader reader, PcdReader::open(path));
  CANYON_TRY(const std::size_t x_at, reader.float_at("x"));
  CANYON_TRY(const std::size_t y_at, reader.float_at("y"));
  CANYON_TRY(const std::size_t error_at, reader.float_at("error"));

  CloudSummary cloud;
  cloud.histogram.assign(ErrorBins::kCount + 2, 0);
  cloud.cell_rms_m.assign(grid.columns * grid.rows, 0.0f);
  std::vector<std::uint32_t> counts(cloud.cell_rms_m.size(), 0);
  for (;;) {
    throw_if_cancelled();
    CANYON_TRY(const std::span<const char> bytes, reader.next());
    if (bytes.empty()) break;
    for (std::size_t at = 0; at < bytes.size(); at += reader.point_bytes()) {
      const char* point = bytes.data() + at;
      const float x = float_at(point + x_at), y = float_at(point + y_at), error_m = float_at(point + error_at);
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
  }
  for (std::size_t i = 0; i < counts.size(); ++i) {
    cloud.cell_rms_m[i] = counts[i] ? std::sqrt(cloud.cell_rms_m[i] / static_cast<float>(counts[i])) : -1.0f;
  }
  return cloud;
}

}  // namespace canyon::report
