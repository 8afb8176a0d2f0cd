// Moving pictures, by giflib.
#include <algorithm>
#include <cstring>
#include <map>
#include <memory>

#include "hextwist/base/types.h"
#include "hextwist/session/view/picture.h"

#ifdef HEXTWIST_GIF
#include <gif_lib.h>
#endif

namespace hextwist {

#ifdef HEXTWIST_GIF
namespace {

constexpr int hundredths_per_picture = 14, n_colours = 256;

struct Source {
  std::string_view bytes;
  std::size_t at = 0;
};
int read_some(GifFileType* file, GifByteType* to, int n) {
  auto& source = *static_cast<Source*>(file->UserData);
  const std::size_t size = std::min(static_cast<std::size_t>(n), source.bytes.size() - source.at);
  std::memcpy(to, source.bytes.data() + source.at, size);
  source.at += size;
  return static_cast<int>(size);
}
int write_some(GifFileType* file, const GifByteType* from, int n) {
  static_cast<std::string*>(file->UserData)->append(reinterpret_cast<const char*>(from), static_cast<std::size_t>(n));
  return n;
}

[[noreturn]] void fail(int code) {
  const char* text = GifErrorString(code);
  throw Error(std::string("the moving picture: ") + (text ? text : "giflib cannot do it"));
}

/// The colours that most pixels have, and per pixel the nearest of them.
struct Indexed {
  std::vector<GifColorType> colours;
  std::vector<GifByteType> pixels;
};
Indexed indexed(const std::vector<Colour>& pixels) {
  constexpr int kept_bits = 0xfc;
  const auto key = [](const Colour& c) {
    return (c[0] & kept_bits) << 16 | (c[1] & kept_bits) << 8 | (c[2] & kept_bits);
  };
  struct Sum {
    std::size_t n = 0;
    std::array<std::size_t, 3> sum{};
    GifByteType place = 0;
  };
  std::map<int, Sum> sums;
  for (const Colour& c : pixels) {
    Sum& sum = sums[key(c)];
    ++sum.n;
    for (int k = 0; k < 3; ++k) sum.sum[k] += c[k];
  }
  std::vector<std::pair<std::size_t, int>> order;
  for (const auto& [colour, sum] : sums) order.emplace_back(sum.n, colour);
  std::ranges::sort(order, std::greater<>());
  Indexed result;
  for (std::size_t i = 0; i < std::min<std::size_t>(order.size(), n_colours); ++i) {
    const Sum& sum = sums[order[i].second];
    GifColorType c;
    c.Red = static_cast<GifByteType>(sum.sum[0] / sum.n);
    c.Green = static_cast<GifByteType>(sum.sum[1] / sum.n);
    c.Blue = static_cast<GifByteType>(sum.sum[2] / sum.n);
    result.colours.push_back(c);
  }
  for (auto& [colour, sum] : sums) {
    int least = 1 << 30;
    for (std::size_t i = 0; i < result.colours.size(); ++i) {
      const GifColorType& c = result.colours[i];
      const int r = static_cast<int>(sum.sum[0] / sum.n) - c.Red, g = static_cast<int>(sum.sum[1] / sum.n) - c.Green,
                b = static_cast<int>(sum.sum[2] / sum.n) - c.Blue, distance = 3 * r * r + 6 * g * g + b * b;
      if (distance >= least) continue;
      least = distance;
      sum.place = static_cast<GifByteType>(i);
    }
  }
  result.colours.resize(n_colours, GifColorType{0, 0, 0});
  result.pixels.reserve(pixels.size());
  for (const Colour& c : pixels) result.pixels.push_back(sums[key(c)].place);
  return result;
}

void add_picture(GifFileType* file, const std::vector<Colour>& pixels, int width, int height) {
  Indexed made = indexed(pixels);
  SavedImage* image = GifMakeSavedImage(file, nullptr);
  if (!image) fail(E_GIF_ERR_NOT_ENOUGH_MEM);
  image->ImageDesc = {0, 0, width, height, false, GifMakeMapObject(n_colours, made.colours.data())};
  image->RasterBits = static_cast<GifByteType*>(std::malloc(made.pixels.size()));
  if (!image->RasterBits || !image->ImageDesc.ColorMap) fail(E_GIF_ERR_NOT_ENOUGH_MEM);
  std::ranges::copy(made.pixels, image->RasterBits);
}

/// How long each picture stays; the first says that all starts again, for ever. Those of a file that is read are not
/// kept by giflib.
void set_times(GifFileType* file) {
  for (int i = 0; i < file->ImageCount; ++i) {
    SavedImage& image = file->SavedImages[i];
    GifFreeExtensions(&image.ExtensionBlockCount, &image.ExtensionBlocks);
    if (i == 0) {
      GifByteType name[] = "NETSCAPE2.0", forever[] = {1, 0, 0};
      GifAddExtensionBlock(&image.ExtensionBlockCount, &image.ExtensionBlocks, APPLICATION_EXT_FUNC_CODE, 11, name);
      GifAddExtensionBlock(&image.ExtensionBlockCount, &image.ExtensionBlocks, CONTINUE_EXT_FUNC_CODE, 3, forever);
    }
    const GraphicsControlBlock control = {DISPOSE_DO_NOT, false, hundredths_per_picture, NO_TRANSPARENT_COLOR};
    EGifGCBToSavedExtension(&control, file, i);
  }
}

}  // namespace

std::string gif(std::string_view file, const std::vector<Colour>& pixels, int width, int height) {
  int code = 0;
  std::string result;
  // Closing a file that is written does not free its pictures.
  const auto close = [](GifFileType* f) {
    GifFreeSavedImages(f);
    EGifCloseFile(f, nullptr);
  };
  std::unique_ptr<GifFileType, decltype(close)> out(EGifOpen(&result, write_some, &code), close);
  if (!out) fail(code);
  out->SWidth = width;
  out->SHeight = height;
  out->SColorResolution = 8;
  if (!file.empty()) {
    Source source{file};
    GifFileType* in = DGifOpen(&source, read_some, &code);
    if (!in) throw Error("this is not a GIF file to add a picture to");
    const std::unique_ptr<GifFileType, void (*)(GifFileType*)> closed(
        in, [](GifFileType* f) { DGifCloseFile(f, nullptr); });
    if (DGifSlurp(in) != GIF_OK) throw Error("this is not a whole GIF file to add a picture to");
    if (in->SWidth != width || in->SHeight != height)
      throw Error("the pictures in this file have " + std::to_string(in->SWidth) + " by " +
                  std::to_string(in->SHeight) + " pixels, not " + std::to_string(width) + " by " +
                  std::to_string(height));
    for (int i = 0; i < in->ImageCount; ++i)
      if (!GifMakeSavedImage(out.get(), &in->SavedImages[i])) fail(E_GIF_ERR_NOT_ENOUGH_MEM);
  }
  add_picture(out.get(), pixels, width, height);
  set_times(out.get());
  GifFileType pictures{};
  pictures.SavedImages = out->SavedImages;
  pictures.ImageCount = out->ImageCount;
  if (EGifSpew(out.get()) != GIF_OK) fail(out->Error);
  [[maybe_unused]] const GifFileType* closed = out.release();  // by writing it
  GifFreeSavedImages(&pictures);
  return result;
}

#else

std::string gif(std::string_view, const std::vector<Colour>&, int, int) {
  throw Error("this program was built without giflib (Debian: libgif-dev), which moving pictures need");
}

#endif

}  // namespace hextwist
