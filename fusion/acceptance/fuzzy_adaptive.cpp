#include <algorithm>
#include <cmath>

#include "canyon/fusion/acceptance/acceptance.h"

namespace canyon::fusion {
namespace {

struct FuzzyAdaptiveParameters {
  double fuzzy_tau_s = 10.0;
  double fuzzy_large = 5.0;
};
void visit(FieldVisitor& f, FuzzyAdaptiveParameters& p) {
  f.number("fuzzy_tau_s", p.fuzzy_tau_s, {0.01, 1e6}, "over which innovations are remembered");
  f.number("fuzzy_large", p.fuzzy_large, {1, 1000}, "factor on the noise's 1-sigma where the rules say large");
}

/// After the idea of the fuzzy-adaptive filter that the paper cites (Sasiadek & Wang 1999, IEEE Int. Conf. Robotics and
/// Automation, 2970-2975); memberships and factors are chosen here: the mean and the size of the last innovations, in
/// units of what the filter expects, are each to some degree zero, small or large; nine rules raise the noise by
/// nothing, by the root of fuzzy_large or by fuzzy_large; what is done is the mean of the rules, weighted by how far
/// each applies.
class FuzzyAdaptive final : public Copied<Acceptance, FuzzyAdaptive> {
 public:
  explicit FuzzyAdaptive(const FuzzyAdaptiveParameters& p) : p_(p) {}
  void start() override {
    weight_ = size_ = 0.0;
    mean_.setZero();
  }

  Decision decide(const Innovation& i) override {
    const double kept = weight_ > 0.0 ? std::exp(-std::max(i.t - last_, 0.0) / p_.fuzzy_tau_s) : 0.0;
    last_ = i.t;
    const auto dof = static_cast<double>(i.residual.size());
    Measurement::Vector normalized = i.residual;
    for (Eigen::Index k = 0; k < normalized.size(); ++k) normalized[k] /= std::sqrt(i.R(k, k) + i.predicted(k, k));
    if (weight_ == 0.0) mean_ = Measurement::Vector::Zero(i.residual.size());
    weight_ = kept * weight_ + 1.0;
    size_ = kept * size_ + i.nis / dof;
    mean_ = kept * mean_ + normalized;
    // A mean of n innovations is zero to 1 / sqrt(n).
    const Grades mean = grades(std::max(0.0, mean_.norm() / weight_ / std::sqrt(dof) - 1.0 / std::sqrt(weight_)));
    const Grades size = grades(std::max(0.0, std::sqrt(size_ / weight_) - 1.0));
    double applied = 0.0, sum = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        const double degree = std::min(mean[a], size[b]);
        applied += degree;
        sum += degree * std::pow(p_.fuzzy_large, 0.5 * static_cast<double>(std::max(a, b)));
      }
    }
    const double factor = sum / applied;
    return {.noise_scale = factor * factor};
  }

 private:
  using Grades = std::array<double, 3>;
  /// How far x >= 0 is zero, small and large: triangles with their tips at 0, 1 and from 3 on.
  static Grades grades(double x) {
    if (x < 1.0) return {1.0 - x, x, 0.0};
    if (x < 3.0) return {0.0, (3.0 - x) / 2.0, (x - 1.0) / 2.0};
    return {0.0, 0.0, 1.0};
  }

  FuzzyAdaptiveParameters p_;
  GpsTime last_;
  double weight_ = 0.0, size_ = 0.0;
  Measurement::Vector mean_;
};

}  // namespace

std::unique_ptr<Acceptance> make_fuzzy_adaptive(const ModelParameters& own) {
  return std::make_unique<FuzzyAdaptive>(own.get<FuzzyAdaptiveParameters>());
}

void fuzzy_adaptive_parameters(ModelParameters& section) {
  section.add<FuzzyAdaptiveParameters>();
}

}  // namespace canyon::fusion
