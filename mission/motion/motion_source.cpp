#include "canyon/mission/motion/motion_source.h"

#include "canyon/core/check.h"

namespace canyon::mission {

namespace {

class DrivenMotion final : public MotionSource {
 public:
  DrivenMotion(const VehicleConfig& config, const scene::Scene& scene, std::uint64_t seed, GpsTime start)
      : vehicle_(config, scene, seed, start) {
    now_.motion = vehicle_.state();
  }

  const TapeNode& advance(const DriveCommand& command) override {
    now_.motion = vehicle_.advance(command);
    now_.speed_m_s = vehicle_.speed_m_s();
    now_.distance_m = vehicle_.distance_m();
    now_.command = command;
    return now_;
  }
  const TapeNode& now() const override { return now_; }
  bool on_terrain() const override { return vehicle_.on_terrain(); }

 private:
  Vehicle vehicle_;
  TapeNode now_;
};

class TapedMotion final : public MotionSource {
 public:
  TapedMotion(const Tape& tape, GpsTime start) : tape_(tape), start_(start) {
    CANYON_CHECK(tape.nodes.size() >= 2, tape.nodes.size(), " nodes");
    place();
  }

  const TapeNode& advance(const DriveCommand&) override {
    CANYON_CHECK(!over(), "the tape of ", tape_.source, " is over");
    ++i_;
    place();
    return now_;
  }
  const TapeNode& now() const override { return now_; }
  bool over() const override { return i_ + 1 == tape_.nodes.size(); }

 private:
  void place() {
    now_ = tape_.nodes[i_];
    now_.motion.t.ns += start_.ns - tape_.nodes.front().motion.t.ns;
  }

  const Tape& tape_;
  GpsTime start_;
  std::size_t i_ = 0;
  TapeNode now_;
};

}  // namespace

std::unique_ptr<MotionSource> make_driven_motion(const VehicleConfig& config, const scene::Scene& scene,
                                                 std::uint64_t seed, GpsTime start) {
  return std::make_unique<DrivenMotion>(config, scene, seed, start);
}

std::unique_ptr<MotionSource> make_taped_motion(const Tape& tape, GpsTime start) {
  return std::make_unique<TapedMotion>(tape, start);
}

}  // namespace canyon::mission
