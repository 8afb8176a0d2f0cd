#include <limits>

#include "hextwist/base/large_array.h"
#include "hextwist/io/hdf5/hdf5_internal.h"
#include "hextwist/io/hdf5/outside_internal.h"

namespace hextwist::io {
namespace {

/// zlib packs 1 to 1100 at best.
constexpr std::uintmax_t most_packed = 1100;

struct Numbers {
  VtkType type;
  hid_t in_memory;
};
/// Of a type in a file; false: no numbers.
bool numbers_of(hid_t type, Numbers& to) {
  const H5T_class_t kind = H5Tget_class(type);
  const std::size_t size = H5Tget_size(type);
  if (kind == H5T_FLOAT && size <= 4)
    to = {VtkType::float32, H5T_NATIVE_FLOAT};
  else if (kind == H5T_FLOAT && size == 8)
    to = {VtkType::float64, H5T_NATIVE_DOUBLE};
  else if (kind != H5T_INTEGER)
    return false;
  else {
    const bool plain = H5Tget_sign(type) == H5T_SGN_NONE;
    if (size == 1)
      to = plain ? Numbers{VtkType::uint8, H5T_NATIVE_UINT8} : Numbers{VtkType::int8, H5T_NATIVE_INT8};
    else if (size == 2)
      to = plain ? Numbers{VtkType::uint16, H5T_NATIVE_UINT16} : Numbers{VtkType::int16, H5T_NATIVE_INT16};
    else if (size == 4)
      to = plain ? Numbers{VtkType::uint32, H5T_NATIVE_UINT32} : Numbers{VtkType::int32, H5T_NATIVE_INT32};
    else if (size == 8)
      to = plain ? Numbers{VtkType::uint64, H5T_NATIVE_UINT64} : Numbers{VtkType::int64, H5T_NATIVE_INT64};
    else
      return false;
  }
  return true;
}

herr_t no_external_link(hid_t group, const char* name, const H5L_info_t* info, void* found) {
  auto& what = *static_cast<std::string*>(found);
  if (info->type != H5L_TYPE_HARD && info->type != H5L_TYPE_SOFT) return what = "a link to another file", 1;
  if (info->type == H5L_TYPE_SOFT) return 0;  // to what is visited anyway
  const Hdf5Id object(H5Oopen(group, name, H5P_DEFAULT), H5Oclose);
  if (object < 0 || H5Iget_type(object) != H5I_DATASET) return 0;
  const Hdf5Id plan(H5Dget_create_plist(object), H5Pclose);
  if (H5Pget_layout(plan) == H5D_VIRTUAL) return what = "a dataset that is put together from others", 1;
  if (H5Pget_external_count(plan) > 0) return what = "a dataset whose values are in another file", 1;
  return 0;
}

}  // namespace

void quiet_hdf5() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

void refuse_links_outside(const std::filesystem::path& file, const std::filesystem::path& folder) {
  if (folder.empty()) return;
  quiet_hdf5();
  const Hdf5Id id(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (id < 0) throw Error(file.string() + ": cannot be opened as HDF5 (damaged or another format)");
  std::string found;
  if (H5Lvisit(id, H5_INDEX_NAME, H5_ITER_NATIVE, no_external_link, &found) < 0)
    throw Error(file.string() + ": cannot be read (damaged file)");
  if (!found.empty())
    throw Error(file.string() + ": has " + found + ", and files may be read below " + folder.string() + " only");
}

Hdf5Reader::Hdf5Reader(const std::filesystem::path& file, std::string name)
    : name_(std::move(name)),
      size_(std::filesystem::file_size(file)),
      file_(
          [&] {
            quiet_hdf5();
            return H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
          }(),
          H5Fclose) {
  if (file_ < 0) fail("cannot be opened as HDF5 (damaged or another format)");
}

bool Hdf5Reader::has(const std::string& path) const {
  // Each part of the way has to be there before the library may be asked for the next.
  for (std::size_t at = path.find('/', 1);; at = path.find('/', at + 1)) {
    const std::string part = path.substr(0, at);
    if (H5Lexists(file_, part.c_str(), H5P_DEFAULT) <= 0) return false;
    if (at == std::string::npos) return H5Oexists_by_name(file_, path.c_str(), H5P_DEFAULT) > 0;
  }
}

bool Hdf5Reader::is_group(const std::string& path) const {
  if (!has(path)) return false;
  const Hdf5Id object(H5Oopen(file_, path.c_str(), H5P_DEFAULT), H5Oclose);
  return object >= 0 && H5Iget_type(object) == H5I_GROUP;
}

std::vector<std::string> Hdf5Reader::members(const std::string& group) const {
  std::vector<std::string> result;
  if (!is_group(group)) return result;
  const Hdf5Id id(H5Gopen2(file_, group.c_str(), H5P_DEFAULT), H5Gclose);
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* to) -> herr_t {
    static_cast<std::vector<std::string>*>(to)->emplace_back(name);
    return 0;
  };
  unsigned kept = 0;
  const Hdf5Id plan(id < 0 ? -1 : H5Gget_create_plist(id), H5Pclose);
  if (plan >= 0) H5Pget_link_creation_order(plan, &kept);
  const auto order = (kept & H5P_CRT_ORDER_INDEXED) != 0 ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME;
  if (id < 0 || H5Literate(id, order, H5_ITER_INC, nullptr, add, &result) < 0)
    fail("group " + shown(group) + " cannot be read (damaged file)");
  return result;
}

bool Hdf5Reader::is_numbers(const std::string& path) const {
  if (!has(path)) return false;
  const Hdf5Id object(H5Oopen(file_, path.c_str(), H5P_DEFAULT), H5Oclose);
  if (object < 0 || H5Iget_type(object) != H5I_DATASET) return false;
  const Hdf5Id type(H5Dget_type(object), H5Tclose);
  Numbers numbers{};
  return type >= 0 && numbers_of(type, numbers);
}

VtkArray Hdf5Reader::array(const std::string& path, std::vector<std::size_t>& sizes) const {
  const auto broken = [&](const char* why) { fail("dataset " + shown(path) + " " + why); };
  if (!has(path)) broken("is not there");
  const Hdf5Id set(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose);
  if (set < 0) broken("cannot be read (damaged file)");
  const Hdf5Id type(H5Dget_type(set), H5Tclose), space(H5Dget_space(set), H5Sclose);
  Numbers numbers{};
  if (type < 0 || space < 0) broken("cannot be read (damaged file)");
  if (!numbers_of(type, numbers)) broken("has no numbers");
  std::array<hsize_t, H5S_MAX_RANK> dimensions{};
  const int rank = H5Sget_simple_extent_dims(space, dimensions.data(), nullptr);
  if (rank < 0) broken("has no sizes");
  sizes.clear();
  std::size_t n = 1;
  for (int d = 0; d < rank; ++d) {
    sizes.push_back(dimensions[static_cast<std::size_t>(d)]);
    if (__builtin_mul_overflow(n, sizes.back(), &n)) broken("has impossible sizes");
  }
  if (rank == 0) sizes.push_back(1);
  VtkArray result;
  result.name = path.substr(path.rfind('/') + 1);
  result.type = numbers.type;
  const std::size_t bytes = vtk_size(numbers.type);
  if (n / most_packed > size_ / bytes + 1) broken("has impossible sizes");
  resize_for_overwrite(result.own, (n * bytes + 7) / 8);
  if (n > 0 && H5Dread(set, numbers.in_memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, result.own.data()) < 0)
    broken("cannot be read (damaged file)");
  result.bytes = {reinterpret_cast<const char*>(result.own.data()), n * bytes};
  return result;
}

std::string Hdf5Reader::text(const std::string& path, const char* attribute) const {
  if (!has(path) || H5Aexists_by_name(file_, path.c_str(), attribute, H5P_DEFAULT) <= 0) return "";
  const Hdf5Id id(H5Aopen_by_name(file_, path.c_str(), attribute, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (id < 0) return "";
  const Hdf5Id type(H5Aget_type(id), H5Tclose), space(H5Aget_space(id), H5Sclose);
  if (type < 0 || H5Tget_class(type) != H5T_STRING || H5Sget_simple_extent_npoints(space) != 1) return "";
  if (H5Tis_variable_str(type) > 0) {
    char* value = nullptr;
    const Hdf5Id memory(H5Tcopy(type), H5Tclose);
    if (H5Aread(id, memory, &value) < 0 || !value) return "";
    std::string result = value;
    H5free_memory(value);
    return result;
  }
  const std::size_t size = H5Tget_size(type);
  if (size > size_) return "";
  std::string result(size, '\0');
  if (H5Aread(id, type, result.data()) < 0) return "";
  return result.substr(0, result.find('\0'));
}

std::int64_t Hdf5Reader::integer(const std::string& path, const char* attribute, std::int64_t none) const {
  if (!has(path) || H5Aexists_by_name(file_, path.c_str(), attribute, H5P_DEFAULT) <= 0) return none;
  const Hdf5Id id(H5Aopen_by_name(file_, path.c_str(), attribute, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (id < 0) return none;
  const Hdf5Id type(H5Aget_type(id), H5Tclose), space(H5Aget_space(id), H5Sclose);
  const hssize_t n = H5Sget_simple_extent_npoints(space);
  if (type < 0 || H5Tget_class(type) != H5T_INTEGER || n < 1 || n > 1000) return none;
  std::vector<std::int64_t> values(static_cast<std::size_t>(n), none);
  return H5Aread(id, H5T_NATIVE_INT64, values.data()) < 0 ? none : values[0];
}

Hdf5Writer::Hdf5Writer(const Replacement& file)
    : replacement_(file),
      file_(
          [&] {
            quiet_hdf5();
            return H5Fcreate(file.temporary().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
          }(),
          H5Fclose) {
  check(file_ >= 0);
}

void Hdf5Writer::group(const std::string& path) const {
  const Hdf5Id plan(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  check(H5Pset_link_creation_order(plan, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED) >= 0);
  const Hdf5Id id(H5Gcreate2(file_, path.c_str(), H5P_DEFAULT, plan, H5P_DEFAULT), H5Gclose);
  check(id >= 0);
}

void Hdf5Writer::write(const std::string& path, hid_t type, const void* data, std::size_t n, std::size_t width) const {
  const std::array<hsize_t, 2> sizes = {n, width};
  const Hdf5Id space(H5Screate_simple(width == 0 ? 1 : 2, sizes.data(), nullptr), H5Sclose);
  const Hdf5Id plan(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(plan, false);  // the same bytes of the same mesh
  const Hdf5Id set(H5Dcreate2(file_, path.c_str(), type, space, H5P_DEFAULT, plan, H5P_DEFAULT), H5Dclose);
  check(space >= 0 && set >= 0);
  if (n > 0) check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
}

void Hdf5Writer::text(const std::string& path, const char* attribute, const std::string& value) const {
  const Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
  check(H5Tset_size(type, std::max<std::size_t>(1, value.size())) >= 0 && H5Tset_strpad(type, H5T_STR_NULLPAD) >= 0);
  const bool ascii = std::ranges::all_of(value, [](char c) { return static_cast<unsigned char>(c) < 128; });
  H5Tset_cset(type, ascii ? H5T_CSET_ASCII : H5T_CSET_UTF8);
  const Hdf5Id id(H5Acreate_by_name(file_, path.c_str(), attribute, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                  H5Aclose);
  check(id >= 0 && H5Awrite(id, type, value.empty() ? "" : value.data()) >= 0);
}

void Hdf5Writer::integers(const std::string& path, const char* attribute,
                          const std::vector<std::int64_t>& values) const {
  const hsize_t n = values.size();
  const Hdf5Id space(H5Screate_simple(1, &n, nullptr), H5Sclose);
  const Hdf5Id id(
      H5Acreate_by_name(file_, path.c_str(), attribute, H5T_NATIVE_INT64, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  check(id >= 0 && H5Awrite(id, H5T_NATIVE_INT64, values.data()) >= 0);
}

void Hdf5Writer::close() {
  check(file_.close() >= 0);
}

}  // namespace hextwist::io
