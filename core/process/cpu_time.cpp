#include "canyon/core/process/cpu_time.h"

#include <ctime>

namespace canyon {
namespace {

std::int64_t clock_ns(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

/// Whose the thread's time is, and since when.
struct Meter {
  CpuAccount* account = nullptr;
  std::int64_t since_ns = 0;
};
thread_local Meter meter;

void switch_to(CpuAccount* account) {
  if (account == meter.account) return;
  const std::int64_t now_ns = clock_ns(CLOCK_THREAD_CPUTIME_ID);
  if (meter.account != nullptr) meter.account->add(now_ns - meter.since_ns);
  meter = {account, now_ns};
}

}  // namespace

ChargeCpu::ChargeCpu(CpuAccount* account) : before_(meter.account) {
  switch_to(account);
}

ChargeCpu::~ChargeCpu() {
  switch_to(before_);
}

CpuAccount* charged_cpu_account() {
  return meter.account;
}

}  // namespace canyon
