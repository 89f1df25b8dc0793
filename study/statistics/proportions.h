#pragma once

#include "canyon/study/statistics/interval.h"

/// Shares of success and what two of them differ by when the same seeds were given to both.
namespace canyon::study {

/// Score interval of the share successes / n (E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209; the formula as Newcombe,
/// Stat. Med. 17 (1998) 857, method 3, gives it). 0 <= successes <= n; without trials undefined.
Interval wilson_interval(int successes, int n);

/// How n pairs came out.
struct PairedCounts {
  int both = 0, only_a = 0, only_b = 0, neither = 0;
  int n() const { return both + only_a + only_b + neither; }
  /// Share of b minus share of a; NaN without pairs.
  double difference() const;
};

/// Interval of that difference: R. G. Newcombe, Stat. Med. 17 (1998) 2635, method 10: the two Wilson intervals squared
/// and added, with the correlation phi of the pairs, corrected for continuity where it is positive. Without pairs
/// undefined.
Interval paired_difference_interval(const PairedCounts& counts);

/// Two-sided p of the hypothesis that neither is the better one: the discordant pairs are tosses of a fair coin (Q.
/// McNemar, Psychometrika 12 (1947) 153, exact). 1 without discordant pairs.
double mcnemar_exact_p(int only_a, int only_b);

/// P(X <= k) of n tosses of a fair coin; 0 for k < 0. n up to millions: sums of ratios to the middle term, + * / only.
double fair_coin_tail(int k, int n);

}  // namespace canyon::study
