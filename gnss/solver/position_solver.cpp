#include "gnss/solver/position_solver.h"

#include "gnss/solver/gauss_newton.h"

namespace canyon::gnss {
namespace {

class LeastSquares final : public PositionSolver {
 public:
  explicit LeastSquares(const PositionSolverParameters& p) : p_(p) {}
  PositionSolution solve(std::span<const RangeMeasurement> ranges, const Eigen::Vector3d& guess_E) const override {
    return solve_ranges(ranges, guess_E, true, p_);
  }
  bool solves_clock() const override { return true; }

 private:
  PositionSolverParameters p_;
};

class Trilateration final : public PositionSolver {
 public:
  explicit Trilateration(const PositionSolverParameters& p) : p_(p) {}
  PositionSolution solve(std::span<const RangeMeasurement> ranges, const Eigen::Vector3d& guess_E) const override {
    return solve_ranges(ranges, guess_E, false, p_);
  }
  bool solves_clock() const override { return false; }

 private:
  PositionSolverParameters p_;
};

constexpr ModelRow<MakePositionSolver> kSolvers[] = {
    {"least_squares", make_least_squares, "iterated weighted least squares for position and receiver clock"},
    {"trilateration", make_trilateration, "the paper's: ranges only, no receiver clock"},
};

}  // namespace

std::span<const ModelRow<MakePositionSolver>> position_solvers() {
  return kSolvers;
}

std::unique_ptr<PositionSolver> make_least_squares(const PositionSolverParameters& p) {
  return std::make_unique<LeastSquares>(p);
}
std::unique_ptr<PositionSolver> make_trilateration(const PositionSolverParameters& p) {
  return std::make_unique<Trilateration>(p);
}

}  // namespace canyon::gnss
