#include "canyon/fusion/estimators/joseph_form.h"

namespace canyon::fusion {
namespace {

/// Errors of position and velocity along E's axes, added to the estimate; attitude as a right perturbation.
class Joseph final : public Copied<Estimator, Joseph> {
 public:
  void set(const ErrorMatrix& P) override { form_.set(P); }
  const ErrorMatrix& covariance() override { return form_.covariance(); }
  void propagate(ErrorPropagation& step) override { form_.propagate(step); }
  void correct(const Measurement& m, const Gain& K, const Measurement::Rows& HP) override { form_.correct(m, K, HP); }
  void inject(ErrorState& state, const ErrorVector& error) override {
    state.inject(error);
    form_.reset_attitude(error.segment<3>(ErrorIndex::kTheta));
  }

 private:
  JosephForm form_;
};

}  // namespace

std::unique_ptr<Estimator> make_joseph() {
  return std::make_unique<Joseph>();
}

}  // namespace canyon::fusion
