#include "canyon/study/gnss_map.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "canyon/core/check.h"
#include "canyon/core/process/parallel.h"
#include "canyon/scene/scene_at.h"

namespace canyon::study {
namespace {

constexpr std::size_t kRowsPerChunk = 8;

Grid empty_grid(const scene::Extent& extent, double cell_m) {
  Grid grid;
  grid.cell_m = cell_m;
  grid.west_m = extent.min.x();
  grid.south_m = extent.min.y();
  grid.columns = std::max(1, static_cast<int>(std::ceil((extent.max.x() - extent.min.x()) / cell_m - 1e-6)));
  grid.rows = std::max(1, static_cast<int>(std::ceil((extent.max.y() - extent.min.y()) / cell_m - 1e-6)));
  grid.values.assign(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows), kNaN);
  return grid;
}

/// Where the antenna of a cell stands; nullopt in a building or off the terrain.
std::optional<Eigen::Vector3d> antenna(const scene::Scene& scene, const Grid& grid, int column, int row,
                                       double height_m) {
  const Eigen::Vector2d xy(grid.west_m + (column + 0.5) * grid.cell_m, grid.south_m + (row + 0.5) * grid.cell_m);
  const auto ground = scene.ground(xy.x(), xy.y());
  if (!ground || scene.building_at(xy) != nullptr) return std::nullopt;
  return Eigen::Vector3d(xy.x(), xy.y(), ground->height_m + height_m);
}

void measure_cell(const GnssMapConfig& config, const scene::SceneAt& scene, gnss::GnssSensor& sensor,
                  const Eigen::Vector3d& p_A_W, std::size_t cell, GnssMap& out) {
  double visible = 0.0, horizontal = 0.0, up = 0.0;
  std::vector<double> gdop;
  for (int k = 0; k < config.epochs; ++k) {
    throw_if_cancelled();
    const double t_s = k * config.step_s;
    const auto epoch =
        sensor.measure(gnss::epoch_index(config.gnss, t_s), config.start + t_s, p_A_W, Eigen::Vector3d::Zero(), scene);
    for (const GnssObservationTruth& s : epoch.truth.satellites) visible += s.line_of_sight ? 1.0 : 0.0;
    if (epoch.fix.status == FixStatus::kNone) continue;
    const Eigen::Vector3d error = scene.scene().frame().to_W(epoch.fix.p_A_E) - p_A_W;
    horizontal += error.head<2>().squaredNorm();
    up += error.z() * error.z();
    gdop.push_back(epoch.fix.dop.gdop);
  }
  const auto fixes = static_cast<double>(gdop.size());
  out.visible.values[cell] = visible / config.epochs;
  out.fix_share.values[cell] = fixes / config.epochs;
  if (gdop.empty()) return;
  out.error_horizontal_m.values[cell] = std::sqrt(horizontal / fixes);
  out.error_up_m.values[cell] = std::sqrt(up / fixes);
  std::nth_element(gdop.begin(), gdop.begin() + static_cast<std::ptrdiff_t>(gdop.size() / 2), gdop.end());
  out.gdop.values[cell] = gdop[gdop.size() / 2];
}

}  // namespace

Result<GnssMap> map_gnss(const GnssMapConfig& config, const scene::Scene& scene, Progress* progress) {
  CANYON_CHECK(config.epochs > 0 && config.cell_m > 0.0, "epochs = ", config.epochs, ", cell_m = ", config.cell_m);
  const Grid grid = empty_grid(scene.extent(), config.cell_m);
  GnssMap out{grid, grid, grid, grid, grid};
  const auto make = [&] {
    return gnss::make_gnss_sensor(config.gnss, config.seed, config.start,
                                  config.start + (config.epochs - 1) * config.step_s, scene);
  };
  // Built once before anything is shared out: what a user can mend is told, and the scene's index is ready.
  if (auto sensor = make(); !sensor) return sensor.error();
  parallel_for(static_cast<std::size_t>(grid.rows), kRowsPerChunk, [&](std::size_t begin, std::size_t end) {
    auto sensor = make();
    const scene::SceneAt at(scene);
    for (std::size_t row = begin; row < end; ++row) {
      throw_if_cancelled();
      for (int column = 0; column < grid.columns; ++column) {
        const auto p_A_W = antenna(scene, grid, column, static_cast<int>(row), config.height_m);
        if (p_A_W) measure_cell(config, at, **sensor, *p_A_W, grid.index(column, static_cast<int>(row)), out);
      }
      if (progress != nullptr) progress->advance(grid.columns);
    }
  });
  return out;
}

}  // namespace canyon::study
