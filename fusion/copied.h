#pragma once

#include <memory>
#include <utility>

namespace canyon::fusion {

/// Gives a model `Model` of an interface that has clone() its own.
template <class Interface, class Model>
class Copied : public Interface {
 public:
  std::unique_ptr<Interface> clone() const final { return std::make_unique<Model>(static_cast<const Model&>(*this)); }
};

/// A model held by its interface that is copied with whatever holds it.
template <class Interface>
class Held {
 public:
  Held() = default;
  Held(std::unique_ptr<Interface> model) : model_(std::move(model)) {}  // NOLINT(google-explicit-constructor)
  Held(const Held& other) : model_(other.model_ ? other.model_->clone() : nullptr) {}
  Held(Held&&) noexcept = default;
  Held& operator=(Held other) noexcept {
    model_ = std::move(other.model_);
    return *this;
  }
  ~Held() = default;

  Interface* operator->() const { return model_.get(); }
  Interface& operator*() const { return *model_; }

 private:
  std::unique_ptr<Interface> model_;
};

}  // namespace canyon::fusion
