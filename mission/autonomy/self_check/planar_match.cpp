#include "canyon/mission/autonomy/self_check/planar_match.h"

#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace canyon::mission {
namespace {

constexpr double kThinned_m = 0.2;
constexpr double kNoise_m = 0.03;  // of a return across a wall, beside what the piece itself is thick
constexpr double kWide_m = 0.12;   // 1-sigma: thicker is no wall
constexpr double kRound = 0.25;    // across over along, 1-sigma: rounder is no wall
constexpr int kFewestPoints = 4;   // points of a piece
constexpr double kGate_m = 0.6;    // farther from a piece is another surface
/// Returns of one wall err alike (its piece, the deskewing): a hundred of them are worth about one.
constexpr double kAlike = 100.0;
constexpr int kIterations = 10;

}  // namespace

PlanarPoints standing_points(const LidarScan& scan, const Pose& X_WL, const Pose& X_WB, const StandingRule& rule) {
  const int half = static_cast<int>(std::ceil(rule.reach_m / kThinned_m)), side = 2 * half;
  std::vector<char> taken(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0);
  const Eigen::Vector3d up = X_WB.R * Eigen::Vector3d::UnitZ(), from = X_WL.p - X_WB.p;
  const Eigen::Matrix3d R = X_WL.R.toRotationMatrix();
  const double yaw = yaw_pitch_roll(X_WB.R).yaw_rad, c = std::cos(yaw), s = std::sin(yaw);
  PlanarPoints points;
  for (const LidarPoint& point : scan.points) {
    const Eigen::Vector3d d = R * Eigen::Vector3f(point.x, point.y, point.z).cast<double>() + from;
    const double above = d.dot(up);
    if (above < rule.low_m || above > rule.high_m || d.head<2>().squaredNorm() >= rule.reach_m * rule.reach_m) continue;
    const Eigen::Vector2d p(c * d.x() + s * d.y(), -s * d.x() + c * d.y());
    const int ix = static_cast<int>(std::floor(p.x() / kThinned_m)) + half,
              iy = static_cast<int>(std::floor(p.y() / kThinned_m)) + half;
    char& before = taken[static_cast<std::size_t>(iy) * static_cast<std::size_t>(side) + static_cast<std::size_t>(ix)];
    if (before != 0) continue;
    before = 1;
    points.push_back(p);
  }
  return points;
}

int WallPieces::cell(const Eigen::Vector2d& p) {
  const int x = static_cast<int>(std::floor(p.x())) + kSide / 2, y = static_cast<int>(std::floor(p.y())) + kSide / 2;
  return x < 0 || y < 0 || x >= kSide || y >= kSide ? -1 : y * kSide + x;
}

WallPieces::WallPieces(const PlanarPoints& points) : pieces_(static_cast<std::size_t>(kSide) * kSide) {
  struct Sums {
    Eigen::Vector2d first{0, 0};
    Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
    int n = 0;
  };
  std::vector<Sums> sums(pieces_.size());
  for (const Eigen::Vector2d& p : points) {
    const int i = cell(p);
    if (i < 0) continue;
    Sums& of = sums[static_cast<std::size_t>(i)];
    of.first += p;
    of.second += p * p.transpose();
    ++of.n;
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const Sums& of = sums[i];
    if (of.n < kFewestPoints) continue;
    const Eigen::Vector2d middle = of.first / of.n;
    const Eigen::Matrix2d scatter = of.second / of.n - middle * middle.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(scatter);
    const double across2 = std::max(0.0, axes.eigenvalues().x()), along2 = axes.eigenvalues().y();
    if (across2 > kWide_m * kWide_m || across2 > kRound * kRound * along2) continue;
    pieces_[i] = {middle, axes.eigenvectors().col(0), across2 + kNoise_m * kNoise_m};
    ++count_;
  }
}

PlanarMotion WallPieces::match(const PlanarPoints& now, const PlanarMotion& before) const {
  const Eigen::Matrix3d known = before.covariance.inverse();
  Eigen::Vector3d x(before.pose.p_m.x(), before.pose.p_m.y(), before.pose.yaw_rad);
  const Eigen::Vector3d x0 = x;
  Eigen::Matrix3d H = known;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const double c = std::cos(x.z()), s = std::sin(x.z());
    H = known;
    Eigen::Vector3d g = known * (x - x0);
    for (const Eigen::Vector2d& p : now) {
      const Eigen::Vector2d turned(c * p.x() - s * p.y(), s * p.x() + c * p.y());
      const Eigen::Vector2d q = turned + x.head<2>();
      const int i = cell(q);
      if (i < 0) continue;
      const Piece& piece = pieces_[static_cast<std::size_t>(i)];
      if (piece.variance_m2 == 0.0) continue;
      const double off = piece.normal.dot(q - piece.middle);
      if (std::abs(off) > kGate_m) continue;
      const double weight = 1.0 / (piece.variance_m2 + off * off) / kAlike;  // Cauchy's
      const Eigen::Vector3d slope(piece.normal.x(), piece.normal.y(),
                                  piece.normal.dot(Eigen::Vector2d(-turned.y(), turned.x())));
      H += weight * slope * slope.transpose();
      g += weight * off * slope;
    }
    const Eigen::Vector3d step = H.ldlt().solve(g);
    x -= step;
    if (step.head<2>().norm() < 1e-4 && std::abs(step.z()) < 1e-5) break;
  }
  return {{x.head<2>(), x.z()}, H.inverse()};
}

}  // namespace canyon::mission
