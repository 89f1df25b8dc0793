// Two autonomies that fail by themselves, under the names of two that do not: for a program of its own
// (tests/CMakeLists.txt), in which this make_autonomy() stands in the place of the library's.
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

#include "canyon/mission/autonomy/autonomy.h"

namespace canyon::mission {
namespace {

constexpr int kSoundCommands = 150;  // at 100 a second

/// Goes straight on at 1 m/s, and then throws, or never answers again.
class Faulty final : public Autonomy {
 public:
  explicit Faulty(bool throws) : throws_(throws) {}
  void see(const LidarScan&, const Pose&, const NavEstimate&) override {}
  DriveCommand drive(const NavEstimate&) override {
    if (left_-- > 0) return {1.0, 0.0};
    if (throws_) throw std::runtime_error("no <idea>");
    for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
  }
  AutonomyState state() const override { return AutonomyState::kDriving; }
  int next_waypoint() const override { return 0; }

 private:
  bool throws_;
  int left_ = kSoundCommands;
};

}  // namespace

std::unique_ptr<Autonomy> make_autonomy(const AutonomyConfig& config, const PriorKnowledge& prior, GpsTime start) {
  const std::string& name = config.model.name;
  if (name == "route_follower") return std::make_unique<Faulty>(true);
  if (name == "reference_2012") return std::make_unique<Faulty>(false);
  return model_row(autonomy_models(), name).make(config.model.own, config, prior, start);
}

}  // namespace canyon::mission
