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

/// Goes straight on at 1 m/s, and then throws, or never answers again; with [autonomy] hold_s = 7 already when it is
/// made.
class Faulty final : public Autonomy {
 public:
  Faulty(bool throws, bool when_made) : throws_(throws) {
    if (when_made) fail();
  }
  void see(const LidarScan&, const Pose&, const NavEstimate&) override {}
  DriveCommand drive(const NavEstimate&) override {
    if (left_-- > 0) return {1.0, 0.0};
    fail();
  }
  AutonomyState state() const override { return AutonomyState::kDriving; }
  int next_waypoint() const override { return 0; }

 private:
  [[noreturn]] void fail() const {
    if (throws_) throw std::runtime_error("no <idea>");
    for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
  }

  bool throws_;
  int left_ = kSoundCommands;
};

}  // namespace

std::unique_ptr<Autonomy> make_autonomy(const AutonomyConfig& config, const PriorKnowledge& prior, GpsTime start) {
  const std::string& name = config.model.name;
  const bool when_made = config.hold_s == 7.0;
  if (name == "route_follower") return std::make_unique<Faulty>(true, when_made);
  if (name == "reference_2012") return std::make_unique<Faulty>(false, when_made);
  return model_row(autonomy_models(), name).make(config.model.own, config, prior, start);
}

}  // namespace canyon::mission
