#include "canyon/gnss/paths/rows/facet_rows.h"

#include <algorithm>
#include <limits>

#include "canyon/core/process/vector_clones.h"

namespace canyon::gnss {
namespace {

constexpr std::size_t kFacetRow = 16;  // facets that are looked at together
constexpr std::size_t kRowsAtOnce = 8;

/// Rows of facets in plain arrays: the ball around each row, and of its facets their own balls and planes.
struct FacetColumns {
  const double *row_x, *row_y, *row_z, *row_radius;
  std::size_t rows;  ///< a multiple of kRowsAtOnce
  const float *x, *y, *z, *radius, *nx, *ny, *nz, *offset;
};
/// A pyramid from an apex through a window, and the same in single precision with slack: the window's plane first, then
/// the sides.
struct BeamPlanes {
  double window[4];
  double apex[3];
  double sides[4][3];
  float image[3];
  float planes[5][4];
  float slack_m;
};

/// Writes the places of facets that may be met through the window, and that face the apex; returns how many. There is
/// room for all.
CANYON_VECTOR_CLONES std::size_t write_met(const FacetColumns& all, const BeamPlanes& beam, std::uint32_t* out) {
  std::uint32_t* next = out;
  for (std::size_t first = 0; first < all.rows; first += kRowsAtOnce) {
    double row_room[kRowsAtOnce];
    for (std::size_t j = 0; j < kRowsAtOnce; ++j) {
      const std::size_t i = first + j;
      const double height =
          beam.window[0] * all.row_x[i] + beam.window[1] * all.row_y[i] + beam.window[2] * all.row_z[i];
      row_room[j] = height - beam.window[3] + all.row_radius[i];
    }
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t j = 0; j < kRowsAtOnce; ++j) {
        const std::size_t i = first + j;
        const double vx = all.row_x[i] - beam.apex[0], vy = all.row_y[i] - beam.apex[1];
        const double vz = all.row_z[i] - beam.apex[2];
        const double inside = beam.sides[k][0] * vx + beam.sides[k][1] * vy + beam.sides[k][2] * vz + all.row_radius[i];
        row_room[j] = inside < row_room[j] ? inside : row_room[j];
      }
    }
    for (std::size_t r = 0; r < kRowsAtOnce; ++r) {
      if (row_room[r] < 0.0) continue;
      const std::size_t begin = (first + r) * kFacetRow;
      float room[kFacetRow];
      for (std::size_t j = 0; j < kFacetRow; ++j) {
        const std::size_t i = begin + j;
        room[j] = all.nx[i] * beam.image[0] + all.ny[i] * beam.image[1] + all.nz[i] * beam.image[2] - all.offset[i] +
                  beam.slack_m;
      }
      for (std::size_t k = 0; k < 5; ++k) {
        const float px = beam.planes[k][0], py = beam.planes[k][1], pz = beam.planes[k][2], off = beam.planes[k][3];
        for (std::size_t j = 0; j < kFacetRow; ++j) {
          const std::size_t i = begin + j;
          const float inside = px * all.x[i] + py * all.y[i] + pz * all.z[i] - off + all.radius[i];
          room[j] = inside < room[j] ? inside : room[j];
        }
      }
      for (std::size_t j = 0; j < kFacetRow; ++j)
        if (room[j] > 0.0F) *next++ = static_cast<std::uint32_t>(begin + j);
    }
  }
  return static_cast<std::size_t>(next - out);
}

constexpr float kSlack_m = 0.01F;

}  // namespace

void FacetRows::fill(const std::vector<scene::Facet>& facets) {
  const std::size_t rows = (ids.size() + kFacetRow - 1) / kFacetRow;
  rows_ = (rows + kRowsAtOnce - 1) / kRowsAtOnce * kRowsAtOnce;
  for (auto* a : {&x_, &y_, &z_, &nx_, &ny_, &nz_, &offset_}) a->assign(rows_ * kFacetRow, 0.0F);
  // What fills up a row lies within no beam.
  radius_.assign(rows_ * kFacetRow, -std::numeric_limits<float>::infinity());
  for (auto* a : {&row_x_, &row_y_, &row_z_}) a->assign(rows_, 0.0);
  row_radius_.assign(rows_, -std::numeric_limits<double>::infinity());
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t begin = row * kFacetRow, end = std::min(begin + kFacetRow, ids.size());
    Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
    for (std::size_t i = begin; i < end; ++i) {
      const scene::Facet& f = facets[ids[i]];
      x_[i] = static_cast<float>(f.center_W.x());
      y_[i] = static_cast<float>(f.center_W.y());
      z_[i] = static_cast<float>(f.center_W.z());
      radius_[i] = static_cast<float>(f.radius_m);
      nx_[i] = static_cast<float>(f.normal_W.x());
      ny_[i] = static_cast<float>(f.normal_W.y());
      nz_[i] = static_cast<float>(f.normal_W.z());
      offset_[i] = static_cast<float>(f.offset_m);
      low = low.cwiseMin((f.center_W.array() - f.radius_m).matrix());
      high = high.cwiseMax((f.center_W.array() + f.radius_m).matrix());
    }
    const Eigen::Vector3d middle = 0.5 * (low + high);
    row_x_[row] = middle.x(), row_y_[row] = middle.y(), row_z_[row] = middle.z();
    row_radius_[row] = 0.5 * (high - low).norm();
  }
}

void FacetRows::meet(const scene::Facet& window, const Beam& beam, std::vector<std::uint32_t>& out) const {
  BeamPlanes planes;
  const auto put = [](const Eigen::Vector3d& v, double* to) { std::copy_n(v.data(), 3, to); };
  const auto put_plane = [](const Eigen::Vector3d& n, double offset_m, float* to) {
    for (Eigen::Index k = 0; k < 3; ++k) to[k] = static_cast<float>(n[k]);
    to[3] = static_cast<float>(offset_m - kSlack_m);
  };
  put(window.normal_W, planes.window);
  planes.window[3] = window.offset_m;
  put(beam.apex_W, planes.apex);
  put_plane(window.normal_W, window.offset_m, planes.planes[0]);
  for (std::size_t k = 0; k < 4; ++k) {
    put(beam.inward_W[k], planes.sides[k]);
    put_plane(beam.inward_W[k], beam.inward_W[k].dot(beam.apex_W), planes.planes[k + 1]);
  }
  for (Eigen::Index k = 0; k < 3; ++k) planes.image[k] = static_cast<float>(beam.apex_W[k]);
  planes.slack_m = kSlack_m;
  out.resize(rows_ * kFacetRow);
  out.resize(write_met({row_x_.data(), row_y_.data(), row_z_.data(), row_radius_.data(), rows_, x_.data(), y_.data(),
                        z_.data(), radius_.data(), nx_.data(), ny_.data(), nz_.data(), offset_.data()},
                       planes, out.data()));
  for (std::uint32_t& place : out) place = ids[place];
}

}  // namespace canyon::gnss
