#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "canyon/tests/report/synthetic_city.h"
#include "canyon/tests/report/synthetic_results.h"

namespace canyon::testing {

/// One made-up run: its epochs, its map points and its entry in summary.json, all from the same numbers.
class SyntheticRun {
 public:
  SyntheticRun(const SyntheticCity& city, const SyntheticOptions& options, std::string fidelity, std::string gnss,
               std::string imu);

  nlohmann::ordered_json summary() const;
  std::string nav_csv() const;
  std::string gnss_csv() const;
  std::string satellites_csv() const;  ///< empty for low GNSS: it has none
  std::string keyframes_csv() const;
  std::string cloud_pcd(bool registered) const;
  bool has_satellites() const { return gnss_ != "low"; }

 private:
  static constexpr double kStop_s = 6;

  struct Epoch {
    double t_s, along_m, speed_m_s;
    Eigen::Vector2d p;
    Eigen::Vector3d error, sigma;
    int waypoint;
    bool stopped;
  };
  struct Satellite {
    int prn;
    double elevation_deg, azimuth_deg, multipath_m, cn0_dbhz;
    bool line_of_sight, tracked;
    int reflections;
  };
  struct Fix {
    double t_s;
    Eigen::Vector2d p;
    bool solved;
    double gdop, pdop, hdop, vdop, multipath_max_m;
    Eigen::Vector3d error, sigma;
    std::vector<Satellite> satellites;
    int used, tracked, blocked, reflected;
  };
  struct Keyframe {
    double t_s;
    Eigen::Vector2d p;
    Eigen::Vector3d prior, registered;
    bool converged;
  };
  struct Point {
    float x, y, z, intensity, error;
  };

  void drive();
  void receive();
  Fix receive_at(std::size_t k, const Epoch& epoch) const;
  void estimate();
  void register_keyframes();
  void map();
  const Epoch& epoch_at(double t_s) const;

  const SyntheticCity& city_;
  SyntheticOptions options_;
  std::string fidelity_, gnss_, imu_;
  bool fails_ = false;
  std::vector<Epoch> epochs_;
  std::vector<Fix> fixes_;
  std::vector<Keyframe> keyframes_;
  std::vector<Point> prior_points_, registered_points_;
};

}  // namespace canyon::testing
