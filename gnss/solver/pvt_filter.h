#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "canyon/gnss/solver/position_solver.h"
#include "canyon/gnss/solver/reported_covariance.h"
#include "canyon/gnss/solver/velocity.h"

namespace canyon::gnss {

/// How a receiver's epochs hang together.
enum class Estimator { kLeastSquares, kKalman };
ModelTable<Estimator> estimators();

/// Process noise as spectral densities, and the gates.
struct PvtFilterParameters {
  double acceleration_m_s2 = 1.0;    ///< white acceleration per axis, m/s^2/sqrt(Hz)
  double clock_m = 0.3;              ///< white frequency noise of the receiver clock, times c: m/sqrt(s)
  double drift_m_s = 0.05;           ///< random walk of its drift: m/s/sqrt(s)
  double inter_system_m = 0.003;     ///< random walk of the difference of two systems' clocks: m/sqrt(s)
  double gate_probability = 1e-4;    ///< that a good measurement's innovation is refused
  double longest_gap_s = 120.0;      ///< after a longer one it begins anew
  double unknown_speed_m_s = 30.0;   ///< 1-sigma of the velocity where the first epoch has no Doppler
  PositionSolverParameters start{};  ///< of the least squares that begins it
};

/// Position, velocity and time by a Kalman filter: constant velocity with white acceleration, clock with drift, and for
/// each further system the difference of its clock. It needs no four satellites once it runs.
///
/// Its own covariance takes errors for white and for as large as assumed. With a report it keeps a second one, of its
/// actual gains and errors as the report has them, each satellite's a Gauss-Markov process that the report's
/// correlation time belongs to: covariance analysis of a suboptimal filter with consider states (Gelb 1974, section
/// 7.2; Jazwinski 1970, section 8.4). Estimates do not change by it.
class PvtFilter {
 public:
  explicit PvtFilter(const PvtFilterParameters& p) : p_(p) {}

  struct Estimate {
    bool ok = false;
    std::string reason;  ///< why not, in a sentence; empty if ok
    Eigen::Vector3d p_E = Eigen::Vector3d::Constant(kNaN), v_E = Eigen::Vector3d::Constant(kNaN);
    double clock_m = kNaN, drift_m_s = kNaN;
    /// Of [p_E; v_E].
    Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Constant(kNaN);
    std::vector<bool> ranges_used;  ///< false: outside the gate
    double nis = kNaN;              ///< normalised innovation squared of what was used
    int nis_degrees = 0;
    bool begun_anew = false;

    /// Puts position, velocity, clock and covariances into a fix; leaves it as it is unless ok.
    void fill(GnssFix& fix) const;
  };
  /// What makes the covariance that is given out; `signals` run parallel to the ranges.
  struct Report {
    const RangeErrorReport& errors;
    std::span<const RangeSignal> signals;
  };
  /// Times must ascend. Either list may be empty. `guess_E`: for the first epoch, as poor as the Earth's centre. The
  /// same report at every epoch, or none.
  Estimate update(GpsTime t, std::span<const RangeMeasurement> ranges, std::span<const RateMeasurement> rates,
                  const Eigen::Vector3d& guess_E, const Report* report = nullptr);
  /// Where it expects to be; nullopt before it runs.
  std::optional<Eigen::Vector3d> predicted_p_E(GpsTime t) const;
  /// Forgets all: the next epoch begins anew.
  void reset() { running_ = false; }

 private:
  static constexpr int kP = 0, kV = 3, kClock = 6, kDrift = 7, kBetween = 8, kSize = 11;
  using State = Eigen::Matrix<double, kSize, 1>;
  using Covariance = Eigen::Matrix<double, kSize, kSize>;
  struct Innovations;
  /// The second covariance: of the state, and of the state with each satellite's error in units of its sigma.
  struct Consider {
    Covariance P = Covariance::Zero();
    struct With {
      State c;
      GpsTime t;
    };
    std::map<std::uint32_t, With> with;
  };

  bool begin(GpsTime t, std::span<const RangeMeasurement> ranges, std::span<const RateMeasurement> rates,
             const Eigen::Vector3d& guess_E, Estimate& out, const Report* report);
  void predict(double dt_s, const Report* report);
  std::vector<double> reported_sigmas(const Innovations& all, std::span<const RangeMeasurement> ranges,
                                      const Report& report) const;
  void consider(const Innovations& all, const std::vector<Eigen::Index>& used, const Eigen::MatrixXd& H,
                const Eigen::MatrixXd& K, const std::vector<double>& sigma_m, const Report& report);
  Innovations innovations(std::span<const RangeMeasurement> ranges, std::span<const RateMeasurement> rates) const;
  bool take_clock_jump(std::span<const RangeMeasurement> ranges);
  void describe(Estimate& out, const Report* report) const;

  PvtFilterParameters p_;
  bool running_ = false;
  GpsTime t_;
  State x_ = State::Zero();
  Covariance P_ = Covariance::Zero();
  Consider reported_;
};

}  // namespace canyon::gnss
