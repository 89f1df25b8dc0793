#include "canyon/scene/city/terrain.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/random/random.h"

namespace canyon::scene::city {
namespace {

constexpr double kHillSpacing_m = 250.0;

/// Weights of the uniform cubic B-spline at 0 <= u < 1: twice differentiable, and of + - * only, so that the ground has
/// the same bits on every machine.
std::array<double, 4> spline_weights(double u) {
  const double u2 = u * u, u3 = u2 * u;
  return {(1.0 - 3.0 * u + 3.0 * u2 - u3) / 6.0, (4.0 - 6.0 * u2 + 3.0 * u3) / 6.0,
          (1.0 + 3.0 * u + 3.0 * u2 - 3.0 * u3) / 6.0, u3 / 6.0};
}

/// Hills of about +-1: a spline surface through random control heights.
double hills(const RandomStream& stream, double x, double y) {
  constexpr double kGain = 2.0;  // control heights in [-1, 1] give a surface of about half that
  constexpr int kOffset = 1024;  // keeps stream indices positive
  const double gx = x / kHillSpacing_m, gy = y / kHillSpacing_m;
  const double fx = std::floor(gx), fy = std::floor(gy);
  const auto wx = spline_weights(gx - fx), wy = spline_weights(gy - fy);
  double sum = 0.0;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      const auto entity = static_cast<std::uint32_t>(static_cast<int>(fx) + i + kOffset);
      const auto index = static_cast<std::uint64_t>(static_cast<int>(fy) + j + kOffset);
      sum +=
          wx[static_cast<std::size_t>(i)] * wy[static_cast<std::size_t>(j)] * stream.uniform(-1.0, 1.0, entity, index);
    }
  }
  return kGain * sum;
}

}  // namespace

Terrain::Terrain(const CityConfig& config)
    : n_(std::max(1, static_cast<int>(std::lround(config.extent_m / config.terrain_cell_m)))),
      half_m_(0.5 * config.extent_m),
      cell_m_(config.extent_m / n_) {
  const RandomStream stream(static_cast<std::uint64_t>(config.seed), "scene.city.terrain");
  const double rise = config.slope_percent / 100.0 / std::sqrt(2.0);
  const double at_origin = config.hill_height_m * hills(stream, 0.0, 0.0);
  height_m_.resize(vertex(n_, n_) + 1);
  material_.assign(static_cast<std::size_t>(n_) * static_cast<std::size_t>(n_), 0);
  for (int row = 0; row <= n_; ++row) {
    throw_if_cancelled();
    for (int column = 0; column <= n_; ++column) {
      const double x = -half_m_ + column * cell_m_, y = -half_m_ + row * cell_m_;
      height_m_[vertex(column, row)] =
          static_cast<float>(rise * (x + y) + config.hill_height_m * hills(stream, x, y) - at_origin);
    }
  }
}

double Terrain::height(double x, double y) const {
  const double u = std::clamp((x + half_m_) / cell_m_, 0.0, static_cast<double>(n_));
  const double v = std::clamp((y + half_m_) / cell_m_, 0.0, static_cast<double>(n_));
  const int column = std::min(static_cast<int>(u), n_ - 1), row = std::min(static_cast<int>(v), n_ - 1);
  const double du = u - column, dv = v - row;
  const double z00 = height_m_[vertex(column, row)], z10 = height_m_[vertex(column + 1, row)];
  const double z01 = height_m_[vertex(column, row + 1)], z11 = height_m_[vertex(column + 1, row + 1)];
  return du >= dv ? z00 + du * (z10 - z00) + dv * (z11 - z10) : z00 + dv * (z01 - z00) + du * (z11 - z01);
}

Eigen::Vector3d Terrain::normal(double x, double y) const {
  const double step_m = 2.0;  // about a car's wheelbase
  const double dx = (height(x + step_m, y) - height(x - step_m, y)) / (2.0 * step_m);
  const double dy = (height(x, y + step_m) - height(x, y - step_m)) / (2.0 * step_m);
  return Eigen::Vector3d(-dx, -dy, 1.0).normalized();
}

Terrain::Span Terrain::span(double x0, double y0, double x1, double y1) const {
  constexpr int kSteps = 16;
  Span result{height(x0, y0), height(x0, y0)};
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      const double z = height(x0 + (x1 - x0) * i / kSteps, y0 + (y1 - y0) * j / kSteps);
      result.low_m = std::min(result.low_m, z);
      result.high_m = std::max(result.high_m, z);
    }
  }
  return result;
}

void Terrain::paint(double x0, double y0, double x1, double y1, std::uint16_t material) {
  const auto cell_from = [&](double x) {
    return std::clamp(static_cast<int>(std::ceil((x + half_m_) / cell_m_ - 0.5)), 0, n_);
  };
  throw_if_cancelled();
  for (int row = cell_from(y0); row < cell_from(y1); ++row) {
    for (int column = cell_from(x0); column < cell_from(x1); ++column) {
      material_[static_cast<std::size_t>(row) * static_cast<std::size_t>(n_) + static_cast<std::size_t>(column)] =
          material;
    }
  }
}

void Terrain::add_to(SceneParts& parts) const {
  Mesh& mesh = parts.mesh;
  const std::uint32_t object = MeshBuilder(parts).begin_object("terrain", ObjectKind::kTerrain);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int row = 0; row <= n_; ++row) {
    throw_if_cancelled();
    for (int column = 0; column <= n_; ++column) {
      mesh.vertices.emplace_back(static_cast<float>(-half_m_ + column * cell_m_),
                                 static_cast<float>(-half_m_ + row * cell_m_), height_m_[vertex(column, row)]);
    }
  }
  for (int row = 0; row < n_; ++row) {
    throw_if_cancelled();
    for (int column = 0; column < n_; ++column) {
      const auto at = [&](int c, int r) { return first + static_cast<std::uint32_t>(vertex(c, r)); };
      mesh.triangles.push_back({at(column, row), at(column + 1, row), at(column + 1, row + 1)});
      mesh.triangles.push_back({at(column, row), at(column + 1, row + 1), at(column, row + 1)});
      const std::uint16_t material =
          material_[static_cast<std::size_t>(row) * static_cast<std::size_t>(n_) + static_cast<std::size_t>(column)];
      mesh.material.insert(mesh.material.end(), 2, material);
      mesh.object.insert(mesh.object.end(), 2, object);
    }
  }
}

}  // namespace canyon::scene::city
