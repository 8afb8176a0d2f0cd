// A part among others that are refined for sizes: the techniques that are tried, and what is decided together.
#pragma once

#include <memory>

#include "hextwist/parts/local_mesh.h"
#include "hextwist/sizing/among_parts.h"

namespace hextwist {

/// Another part could not go on; it says why.
struct OthersFailed : Error {
  OthersFailed() : Error("another part could not go on") {}
};

class SizeTries final : public AmongParts {
 public:
  /// Of a request for anything else nothing is asked, nor of one for which there is nothing to choose from.
  SizeTries(const LocalMesh& local, const Asked& asked, const OfWhole& whole, const NumbersOfAll& numbers);

  bool is_for_sizes() const { return is_for_sizes_; }
  bool have_any() const { return !tries_.empty(); }
  /// The passes of what was taken.
  PassRecorder take_recorder();
  /// All that was tried counts, not only what was taken.
  void mix_into(std::vector<std::uint64_t>& digest) const;

  /// When all is decided. Throws OthersFailed, as all() does.
  void finish();
  /// Tells the others, where they may still ask.
  void fail();

  PartNumbers all(const PartNumbers& mine) override;
  int begin(State& tried) override;
  void end(const RefineResult& made) override;
  bool is_same(int a, int b) const override;
  void wished(const LevelMarks& marks) override;

 private:
  const LocalMesh& local_;
  const NumbersOfAll& numbers_;
  bool is_for_sizes_ = false, may_ask_ = false;
  struct Try {
    PassRecorder recorder;
    std::vector<std::uint64_t> own_history;
  };
  std::vector<std::unique_ptr<Try>> tries_;
  std::vector<std::uint64_t> digest_;  // per base hex
  LevelMarks wished_;
  int n_looks_ = 0;
};

}  // namespace hextwist
