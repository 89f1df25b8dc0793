#include <algorithm>

#include "canyon/fusion/acceptance/lost_way.h"

namespace canyon::fusion {
namespace {

struct StudentTParameters {
  double student_t_dof = 4.0;
};
void visit(FieldVisitor& f, StudentTParameters& p) {
  f.number("student_t_dof", p.student_t_dof, {0.1, 1e6}, "degrees of freedom of the noise; many: normal");
}

/// Noise of Student's t distribution: given the innovation, its covariance is expected to be (nu + nis) / (nu + dof)
/// times that stated (Piche, Sarkka & Hartikainen 2012,
/// who iterate it; this is its first step). What is nearer than expected is not taken for better.
class StudentT final : public Copied<Acceptance, StudentT> {
 public:
  StudentT(const StudentTParameters& p, const LostWayParameters& lost) : p_(p), lost_(lost) {}
  void start() override { lost_.start(); }
  void moved(const Eigen::Vector3d& by_m, bool by_this) override { lost_.moved(by_m, by_this); }
  Decision decide(const Innovation& i) override {
    if (lost_.found(i)) return lost_.recovery(i);
    const double dof = static_cast<double>(i.residual.size());
    return {.noise_scale = std::max(1.0, (p_.student_t_dof + i.nis) / (p_.student_t_dof + dof))};
  }

 private:
  StudentTParameters p_;
  LostWay lost_;
};

}  // namespace

std::unique_ptr<Acceptance> make_student_t(const ModelParameters& own) {
  return std::make_unique<StudentT>(own.get<StudentTParameters>(), own.get<LostWayParameters>());
}

void student_t_parameters(ModelParameters& section) {
  section.add<StudentTParameters>();
  lost_way_parameters(section);
}

}  // namespace canyon::fusion
