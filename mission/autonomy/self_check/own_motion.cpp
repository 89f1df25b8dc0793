#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/units.h"
#include "canyon/mission/autonomy/self_check/planar_match.h"
#include "canyon/mission/autonomy/self_check/self_check.h"

namespace canyon::mission {
namespace {

struct OwnMotionParameters {
  double false_alarm = 1e-4;
  double window_s = 20.0;
  double course_share = 0.01;
  double doubt_sigma_m = 5.0;
  double lost_after_s = 12.0;
  double speed_m_s = 2.0;
};
void visit(FieldVisitor& f, OwnMotionParameters& p) {
  f.number("false_alarm", p.false_alarm, {1e-12, 0.1},
           "own_motion: chance that two estimates seem to contradict the way between them, if all is as they say");
  f.number("window_s", p.window_s, {5, 600}, "own_motion: how far back estimates are compared");
  f.number("course_share", p.course_share, {0, 0.5},
           "own_motion: 1-sigma of its own way by heading and wheel, as a share of that way");
  f.number("doubt_sigma_m", p.doubt_sigma_m, {0.1, 1e4},
           "own_motion: an estimate that is less sure than this, in any horizontal direction, is doubtful by itself");
  f.number("lost_after_s", p.lost_after_s, {0, 600}, "own_motion: doubt that lasts so long is being lost");
  f.number("speed_m_s", p.speed_m_s, {0.1, 30}, "own_motion: how fast it drives in doubt");
}

constexpr double kEvery_m = 1.5, kEvery_s = 1.0;  // between two looks
constexpr double kStands_m = 0.05;                // less between two looks is standing
constexpr int kFewest = 5;                        // earlier looks that an estimate is held against

/// Keeps its own account of the way, by wheel and scan match, with the estimate's heading alone in common, and
/// compares: an estimate that differs from more than half of the last ones it believed by more than they and the way
/// between may err is doubtful, and is none of those that later ones are held against. So it finds one that jumps at
/// once, one that wanders off as soon as it has gone farther than the way may err, and one that comes back is believed
/// again.
class OwnMotion final : public SelfCheck {
 public:
  explicit OwnMotion(const OwnMotionParameters& p) : p_(p), bound_(chi_square_threshold(p.false_alarm, 2)) {}

  void count(const OdometerSample& sample) override {
    counted_ = true;
    wheel_m_ += sample.speed_m_s * sample.dt_s;
  }

  void see(const LidarScan& scan, const Pose& X_WL, const NavEstimate& estimate) override {
    const double yaw = yaw_pitch_roll(estimate.X_WB.R).yaw_rad;
    if (!last_) {
      begin(scan, X_WL, estimate, yaw);
      return;
    }
    const double dt_s = estimate.t - last_->t;
    const PlanarMotion before = reckoned(estimate, yaw, dt_s);
    const double way_m = before.pose.p_m.norm();
    if (way_m < kEvery_m && dt_s < kEvery_s) return;
    if (!counted_ || way_m >= kStands_m) move(scan, X_WL, estimate, before, yaw);
    judge(estimate);
    last_->t = estimate.t;
  }

  Trust trust() const override {
    if (lost_) return Trust::kLost;
    return doubt_since_ ? Trust::kDoubtful : Trust::kGood;
  }
  double speed_limit_m_s() const override { return p_.speed_m_s; }
  std::optional<KeptReturns> keeps() const override {
    return KeptReturns{.low_m = rule_.low_m, .high_m = rule_.high_m, .half_size_m = rule_.reach_m, .enough = 0};
  }

 private:
  /// The last look, and how the vehicle was headed and what it saw when it last had moved.
  struct Last {
    GpsTime t;
    double yaw = 0.0;
    WallPieces walls;
  };
  /// The estimate beside the own way at one look.
  struct Look {
    GpsTime t;
    Eigen::Vector2d way_m, beside_m;  ///< the own way in W from wherever it began; the estimate less that
    Eigen::Matrix2d estimate_m2, way_m2;
  };

  void begin(const LidarScan& scan, const Pose& X_WL, const NavEstimate& estimate, double yaw) {
    last_ = Last{estimate.t, yaw, WallPieces(standing_points(scan, X_WL, estimate.X_WB, rule_))};
    judge(estimate);
    wheel_m_ = 0.0;
  }

  /// By wheel and heading; without a wheel by the estimated speed, which is hardly believed.
  PlanarMotion reckoned(const NavEstimate& estimate, double yaw, double dt_s) const {
    const double turn = wrap_pi(yaw - last_->yaw);
    const double speed = PlanPose{{0, 0}, yaw}.forward().dot(estimate.v_WB_W.head<2>());
    const double way_m = counted_ ? wheel_m_ : speed * dt_s;
    const double chord = 0.5 * turn;
    PlanarMotion out{{way_m * Eigen::Vector2d(std::cos(chord), std::sin(chord)), turn}, Eigen::Matrix3d::Zero()};
    const auto squared = [](double v) { return v * v; };
    const double unsure_m = counted_ ? 0.02 : 0.02 + 1.0 * dt_s;
    out.covariance.diagonal() << squared(unsure_m), squared(unsure_m), squared(0.5 * kDegree);
    return out;
  }

  void move(const LidarScan& scan, const Pose& X_WL, const NavEstimate& estimate, const PlanarMotion& before,
            double yaw) {
    const PlanarPoints points = standing_points(scan, X_WL, estimate.X_WB, rule_);
    const PlanarMotion moved = last_->walls.match(points, before);
    const Eigen::Rotation2Dd R(last_->yaw);
    way_m_ += R * moved.pose.p_m;
    way_m2_ += R * moved.covariance.topLeftCorner<2, 2>() * R.inverse();
    last_->walls = WallPieces(points);
    last_->yaw = yaw;
    wheel_m_ = 0.0;
  }

  /// Horizontal, in W.
  static Eigen::Matrix2d position_m2(const NavEstimate& estimate) {
    const Eigen::Matrix3d R = estimate.X_WB.R.toRotationMatrix();
    return (R * estimate.pose_covariance.bottomRightCorner<3, 3>() * R.transpose()).topLeftCorner<2, 2>();
  }

  void judge(const NavEstimate& estimate) {
    const Look now{estimate.t, way_m_, estimate.X_WB.p.head<2>() - way_m_, position_m2(estimate), way_m2_};
    const auto against = std::count_if(looks_.begin(), looks_.end(), [&](const Look& l) { return differ(now, l); });
    const bool contradicts = looks_.size() >= kFewest && 2 * against > static_cast<std::ptrdiff_t>(looks_.size());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(now.estimate_m2, Eigen::EigenvaluesOnly);
    const bool unsure = axes.eigenvalues().y() > p_.doubt_sigma_m * p_.doubt_sigma_m;
    if (!contradicts && !unsure)
      doubt_since_.reset();
    else if (!doubt_since_)
      doubt_since_ = now.t;
    lost_ = lost_ || (doubt_since_ && now.t - *doubt_since_ >= p_.lost_after_s);
    if (contradicts) return;
    looks_.push_back(now);
    while (now.t - looks_.front().t > p_.window_s) looks_.pop_front();
  }

  bool differ(const Look& now, const Look& then) const {
    constexpr double kFloor_m = 0.1;
    const double course_m = p_.course_share * (now.way_m - then.way_m).norm();
    const Eigen::Matrix2d S = now.estimate_m2 + then.estimate_m2 + now.way_m2 - then.way_m2 +
                              (course_m * course_m + kFloor_m * kFloor_m) * Eigen::Matrix2d::Identity();
    const Eigen::Vector2d d = now.beside_m - then.beside_m;
    return d.dot(S.inverse() * d) > bound_;
  }

  OwnMotionParameters p_;
  double bound_;
  StandingRule rule_;
  bool counted_ = false, lost_ = false;
  double wheel_m_ = 0.0;  ///< since the last look
  std::optional<Last> last_;
  Eigen::Vector2d way_m_{0, 0};
  Eigen::Matrix2d way_m2_ = Eigen::Matrix2d::Zero();
  std::deque<Look> looks_;
  std::optional<GpsTime> doubt_since_;
};

}  // namespace

std::unique_ptr<SelfCheck> make_own_motion(const ModelParameters& own) {
  return std::make_unique<OwnMotion>(own.get<OwnMotionParameters>());
}

void own_motion_parameters(ModelParameters& section) {
  section.add<OwnMotionParameters>();
}

}  // namespace canyon::mission
