// Pixels as a PNG file, by libpng.
#include <png.h>

#include "hextwist/base/types.h"
#include "hextwist/session/view/picture.h"

namespace hextwist {

std::string png(const std::vector<Colour>& pixels, int width, int height) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string file(size, '\0');
  if (!png_image_write_to_memory(&image, file.data(), &size, 0, pixels.data(), 0, nullptr))
    throw Error(std::string("the picture: ") + image.message);
  file.resize(size);
  return file;
}

}  // namespace hextwist
