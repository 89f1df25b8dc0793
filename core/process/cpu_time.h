#pragma once

#include <atomic>
#include <cstdint>

namespace canyon {

/// CPU time that several threads have spent on one thing.
class CpuAccount {
 public:
  CpuAccount() = default;
  CpuAccount(const CpuAccount& other) : ns_(other.ns_.load()) {}
  CpuAccount& operator=(const CpuAccount& other) {
    ns_ = other.ns_.load();
    return *this;
  }

  void add(std::int64_t ns) { ns_ += ns; }
  double seconds() const { return 1e-9 * static_cast<double>(ns_.load()); }

 private:
  std::atomic<std::int64_t> ns_{0};
};

/// While it lives, what the calling thread spends goes to `account` (null = nobody's), and so does what other threads
/// spend on the chunks of its parallel loops (core/process/parallel.h). Then the account from before holds again: of
/// charges inside one another each instant counts once, for the innermost. `account` must outlive it.
class ChargeCpu {
 public:
  explicit ChargeCpu(CpuAccount* account);
  ~ChargeCpu();
  ChargeCpu(const ChargeCpu&) = delete;
  ChargeCpu& operator=(const ChargeCpu&) = delete;

 private:
  CpuAccount* before_;
};

/// Where the calling thread's CPU time goes now; null = nobody's.
CpuAccount* charged_cpu_account();

}  // namespace canyon
