#include "canyon/core/process/progress.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <unistd.h>

namespace canyon {
namespace {

constexpr int kBarWidth = 30;

}  // namespace

Progress::Progress(std::string title, double total, bool enabled)
    : title_(std::move(title)), total_(total), enabled_(enabled && total > 0.0 && isatty(STDERR_FILENO) == 1) {
  if (enabled_) draw(0.0);
}

Progress::~Progress() {
  if (enabled_) std::fputs("\r\033[K", stderr);  // the line is the user's again
}

void Progress::advance(double amount) {
  const double done = done_.fetch_add(amount) + amount;
  if (enabled_) draw(done);
}

void Progress::draw(double done) {
  const double share = std::clamp(done / total_, 0.0, 1.0);
  const int permille = static_cast<int>(share * 1000.0);
  const std::lock_guard lock(mutex_);
  if (permille <= last_permille_) return;
  last_permille_ = permille;
  const int filled = static_cast<int>(share * kBarWidth);
  const std::string bar = std::string(static_cast<std::size_t>(filled), '=') +
                          std::string(static_cast<std::size_t>(kBarWidth - filled), ' ');
  std::fprintf(stderr, "\r%s [%s] %5.1f %%\033[K", title_.c_str(), bar.c_str(), 0.1 * permille);
  std::fflush(stderr);
}

}  // namespace canyon
