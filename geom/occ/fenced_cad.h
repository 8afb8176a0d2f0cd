// CAD that is read behind a fence (base/fence.h).
#pragma once

#include "hextwist/base/fenced.h"
#include "hextwist/geom/occ/model.h"

namespace hextwist::occ {

/// Of the reader.
inline constexpr const char* fenced_cad = "cad";

/// read_cad() of another process. What comes back has been used there: every curve, surface and volume was measured.
CadImport read_cad_fenced(const std::filesystem::path& file, const CadOptions& options);

/// The reader's end of it.
void serve_cad(const FencedJob& job);

}  // namespace hextwist::occ
