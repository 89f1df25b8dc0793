#include "canyon/tests/lidar/registration/trials/tally.h"

#include <cmath>
#include <cstdio>

namespace canyon::lidar::trials {
namespace {

void count_covariance(Tally& tally, const Verdict& v) {
  if (!v.converged || v.closed == 0) return;
  tally.nees += v.nees / v.closed;
  tally.within_95 += v.within_95 ? 1 : 0;
  ++tally.judged;
}

}  // namespace

void Tally::add(const Outcome& o) {
  const Verdict& v = o.verdict;
  ++trials;
  converged += v.converged ? 1 : 0;
  silent += v.silent() ? 1 : 0;
  outside += v.converged && !v.inside ? 1 : 0;
  if (v.right && !o.ambiguous) {
    ++right;
    refused_good += v.converged ? 0 : 1;
  }
  if (o.ambiguous) {
    ++ambiguous;
    recalled += v.undecided ? 1 : 0;
  }
  wide += v.converged && v.widest_3_sigma_m > 0.5 ? 1 : 0;
  all_closed += v.converged && v.closed + o.open_in_truth >= 6 ? 1 : 0;
  all_right += v.converged && o.all_right ? 1 : 0;
  pcl_converged += o.pcl_converged ? 1 : 0;
  pcl_right += o.pcl_right ? 1 : 0;
  pcl_silent += o.pcl_converged && !o.pcl_right ? 1 : 0;
  count_covariance(*this, v);
}

void Tally::add(const Tally& o) {
  trials += o.trials, converged += o.converged, silent += o.silent, outside += o.outside;
  right += o.right, refused_good += o.refused_good, ambiguous += o.ambiguous, recalled += o.recalled, wide += o.wide;
  all_closed += o.all_closed, all_right += o.all_right;
  pcl_converged += o.pcl_converged, pcl_right += o.pcl_right, pcl_silent += o.pcl_silent;
  nees += o.nees, judged += o.judged, within_95 += o.within_95;
}

Tally of_form(std::span<const Outcome> outcomes, std::size_t form) {
  Tally tally;
  for (const Outcome& o : outcomes) count_covariance(tally, o.forms[form]);
  return tally;
}

std::string table_head() {
  return "                                        trials conv right refused silent outside wide  ambiguous    NEES   "
         "95 % | all: closed right "
         "pcl right silent\n";
}

std::string table_row(const std::string& name, const Tally& t) {
  char line[256];
  std::snprintf(line, sizeof line, "%-39s %6d %4d %5d %7d %6d %7d %4d %4d / %4d %7.2f %6.1f | %11d %5d %9d %6d\n",
                name.c_str(), t.trials, t.converged, t.right, t.refused_good, t.silent, t.outside, t.wide, t.recalled,
                t.ambiguous, t.nees_mean(), 100 * t.coverage(), t.all_closed, t.all_right, t.pcl_right, t.pcl_silent);
  return line;
}

namespace {

/// P(X <= k).
double binomial_cdf(int k, int n, double p) {
  double sum = 0;
  for (int i = 0; i <= k; ++i)
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(i + 1.0) - std::lgamma(n - i + 1.0) + i * std::log(p) +
                    (n - i) * std::log1p(-p));
  return sum;
}

}  // namespace

int binomial_most(int n, double p, double alarm) {
  int k = 0;
  while (k < n && 1.0 - binomial_cdf(k, n, p) > alarm) ++k;
  return k;
}

int binomial_fewest(int n, double p, double alarm) {
  return n - binomial_most(n, 1.0 - p, alarm);
}

}  // namespace canyon::lidar::trials
