#include <algorithm>
#include <cmath>

#include "canyon/fusion/acceptance/lost_way.h"

namespace canyon::fusion {
namespace {

struct InnovationAdaptiveParameters {
  double adaptive_tau_s = 10.0;
};
void visit(FieldVisitor& f, InnovationAdaptiveParameters& p) {
  f.number("adaptive_tau_s", p.adaptive_tau_s, {0.01, 1e6}, "over which innovations are remembered");
}

/// Innovation-based adaptive estimation (Mohamed & Schwarz 1999, J. of Geodesy 73), with one factor on R: that with
/// which the mean of r r' - H P H' over the last innovations, weighted by R, is what R says. Never below 1: the stated
/// noise is a lower bound.
class InnovationAdaptive final : public Copied<Acceptance, InnovationAdaptive> {
 public:
  InnovationAdaptive(const InnovationAdaptiveParameters& p, const LostWayParameters& lost) : p_(p), lost_(lost) {}
  void start() override {
    weight_ = sum_ = 0.0;
    lost_.start();
  }

  void moved(const Eigen::Vector3d& by_m, bool by_this) override { lost_.moved(by_m, by_this); }
  Decision decide(const Innovation& i) override {
    if (lost_.found(i)) {
      weight_ = sum_ = 0.0;
      return lost_.recovery(i);
    }
    const double kept = weight_ > 0.0 ? std::exp(-std::max(i.t - last_, 0.0) / p_.adaptive_tau_s) : 0.0;
    last_ = i.t;
    double excess = 0.0;
    for (Eigen::Index k = 0; k < i.residual.size(); ++k)
      excess += (i.residual[k] * i.residual[k] - i.predicted(k, k)) / i.R(k, k);
    excess /= static_cast<double>(i.residual.size());
    weight_ = kept * weight_ + 1.0;
    sum_ = kept * sum_ + excess;
    return {.noise_scale = std::max(1.0, sum_ / weight_)};
  }

 private:
  InnovationAdaptiveParameters p_;
  LostWay lost_;
  GpsTime last_;
  double weight_ = 0.0, sum_ = 0.0;
};

}  // namespace

std::unique_ptr<Acceptance> make_innovation_adaptive(const ModelParameters& own) {
  return std::make_unique<InnovationAdaptive>(own.get<InnovationAdaptiveParameters>(), own.get<LostWayParameters>());
}

void innovation_adaptive_parameters(ModelParameters& section) {
  section.add<InnovationAdaptiveParameters>();
  lost_way_parameters(section);
}

}  // namespace canyon::fusion
