#pragma once

#include <array>
#include <string>
#include <vector>

namespace canyon::gnss {

/// Levels of one state of ITU-R P.681's two-state model (gnss/tables/p681_two_state.csv), dB against a clear signal.
struct SignalState {
  double mean_duration_m;       ///< of those at least as long as the shortest
  double ma_db, ma_sigma_db;    ///< mean level of the direct signal: mean and standard deviation over states
  double h1, h2_db, g1, g2_db;  ///< multipath h1 M_A + h2, standard deviation of the direct signal g1 M_A + g2
};

/// How strong the direct signal is in an environment, by elevation: good state or bad, the mean level M_A normal within
/// a state, and the level normal about it, all in dB. Elevations of the table are 20, 30, 45, 60 and 70 degrees;
/// between them quantiles are interpolated, beyond them those of the end hold.
class TwoStateLaw {
 public:
  static std::vector<std::string> environments();
  /// `shaded_scale`: the table's share of the bad state times this, 1 at most. Throws for an environment that is none.
  TwoStateLaw(const std::string& environment, double shaded_scale);

  struct Elevation {
    double elevation_rad;
    SignalState good, bad;
    double shaded_share;  ///< of the way that is in the bad state
  };
  const std::vector<Elevation>& table() const { return table_; }

  /// M_A, dB, whose share of weaker ones is that of standard normal numbers below z; z counts to +-5.
  double mean_level_db(double z, double elevation_rad) const;
  /// Standard deviation of the level about that mean.
  double spread_db(double mean_level_db, double elevation_rad) const;
  /// Multipath, power against a clear direct signal, at the state's mean level.
  double multipath_power(bool shaded, double elevation_rad) const;

 private:
  static constexpr double kEnd = 5.0, kStep = 0.05;  // of z
  static constexpr std::size_t kNodes = 201;
  struct Between {
    std::size_t low;
    double part;
  };

  void add_quantiles(const Elevation& e);
  Between between(double elevation_rad) const;
  double quantile(std::size_t elevation, double z) const;

  std::vector<Elevation> table_;
  std::vector<std::array<double, kNodes>> quantiles_;
};

}  // namespace canyon::gnss
