#include "canyon/mission/autonomy/planning/recovery.h"

namespace canyon::mission {
namespace {

class WaitOnly final : public Recovery {
 public:
  std::optional<DriveCommand> act(const RecoveryTask&) override { return std::nullopt; }
};

std::unique_ptr<Recovery> make_wait_only() {
  return std::make_unique<WaitOnly>();
}

constexpr ModelRow<MakeRecovery> kRecoveries[] = {
    {"back_up", make_back_up, "waits, then backs up until a way ahead is free", back_up_parameters},
    {"wait", without_keys<make_wait_only>, "waits until something moves"},
};

}  // namespace

ModelTable<MakeRecovery> recoveries() {
  return kRecoveries;
}

}  // namespace canyon::mission
