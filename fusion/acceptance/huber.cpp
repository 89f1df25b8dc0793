#include <algorithm>
#include <cmath>

#include "canyon/fusion/acceptance/lost_way.h"

namespace canyon::fusion {
namespace {

struct HuberParameters {
  double huber_sigma = 1.345;
};
void visit(FieldVisitor& f, HuberParameters& p) {
  f.number("huber_sigma", p.huber_sigma, {0.1, 20},
           "from so many sigma on a deviation counts in proportion, not squared");
}

/// Huber's weight of a residual of d sigma, min(1, k / d), as a larger noise; d per degree of freedom.
class Huber final : public Copied<Acceptance, Huber> {
 public:
  Huber(const HuberParameters& p, const LostWayParameters& lost) : p_(p), lost_(lost) {}
  void start() override { lost_.start(); }
  void moved(const Eigen::Vector3d& by_m, bool by_this) override { lost_.moved(by_m, by_this); }
  Decision decide(const Innovation& i) override {
    if (lost_.found(i)) return lost_.recovery(i);
    const double d = std::sqrt(i.nis / static_cast<double>(i.residual.size()));
    return {.noise_scale = std::max(1.0, d / p_.huber_sigma)};
  }

 private:
  HuberParameters p_;
  LostWay lost_;
};

}  // namespace

std::unique_ptr<Acceptance> make_huber(const ModelParameters& own) {
  return std::make_unique<Huber>(own.get<HuberParameters>(), own.get<LostWayParameters>());
}

void huber_parameters(ModelParameters& section) {
  section.add<HuberParameters>();
  lost_way_parameters(section);
}

}  // namespace canyon::fusion
