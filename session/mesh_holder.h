// Who owns a mesh and who looks at it.
#pragma once

#include <cassert>
#include <memory>
#include <utility>

#include "hextwist/mesh/meshed_model.h"

namespace hextwist {

/// A mesh on its model with one owner. Others hold it by lend(), and as long as one of them does it does not change:
/// the owner then puts another in its place.
class MeshHolder {
 public:
  MeshHolder() : MeshHolder(MeshedModel()) {}
  explicit MeshHolder(MeshedModel meshed) : meshed_(std::make_shared<MeshedModel>(std::move(meshed))) {}

  const MeshedModel& operator*() const { return *meshed_; }
  const MeshedModel* operator->() const { return meshed_.get(); }

  std::shared_ptr<const MeshedModel> lend() const {
    if (auto lent = lent_.lock()) return lent;
    // With a count of its own, which ends when the last borrower lets go.
    const auto share = std::make_shared<const std::shared_ptr<const MeshedModel>>(meshed_);
    std::shared_ptr<const MeshedModel> result(share, meshed_.get());
    lent_ = result;
    return result;
  }
  bool is_lent() const { return !lent_.expired(); }

  /// The mesh, to be changed in place. Precondition: it is not lent.
  MeshedModel& to_change() {
    assert(!is_lent());
    return *meshed_;
  }

  MeshHolder(MeshHolder&&) noexcept = default;
  MeshHolder& operator=(MeshHolder&&) noexcept = default;

 private:
  std::shared_ptr<MeshedModel> meshed_;  // shared with borrowers alone
  mutable std::weak_ptr<const MeshedModel> lent_;
};

}  // namespace hextwist
