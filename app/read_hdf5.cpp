// hextwist_read_hdf5: writes a NetCDF file in the form of HDF5 as classic NetCDF, the same numbers bit by bit, for who
// started it (base/fence.h).
#include <netcdf.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <new>
#include <vector>

#include "hextwist/base/fenced.h"

namespace hextwist::app {
namespace {

constexpr std::size_t piece_bytes = std::size_t{1} << 22;

class Copy {
 public:
  explicit Copy(const FencedJob& job) : name_(job.file.string()) {
    check(nc_open(job.file.c_str(), NC_NOWRITE, &from_));
    check(nc_create(job.to.c_str(), NC_CLOBBER | NC_64BIT_DATA, &to_));
    int before = 0;
    check(nc_set_fill(to_, NC_NOFILL, &before));
  }

  void run() {
    int n_dims = 0, n_variables = 0, n_attributes = 0, endless = -1;
    check(nc_inq(from_, &n_dims, &n_variables, &n_attributes, &endless));
    dimensions(n_dims);
    attributes(NC_GLOBAL, NC_GLOBAL, n_attributes);
    for (int v = 0; v < n_variables; ++v) define(v);
    check(nc_enddef(to_));
    for (int v = 0; v < n_variables; ++v) copy(v);
    check(nc_close(to_));
  }

 private:
  using Name = std::array<char, NC_MAX_NAME + 1>;

  void check(int status) const {
    if (status == NC_ENOMEM) throw std::bad_alloc();
    if (status != NC_NOERR) throw Error(name_ + ": cannot be read: " + nc_strerror(status) + " (damaged file)");
  }

  void dimensions(int n) {
    int n_endless = 0;
    check(nc_inq_unlimdims(from_, &n_endless, nullptr));
    std::vector<int> endless(static_cast<std::size_t>(n_endless));
    check(nc_inq_unlimdims(from_, nullptr, endless.data()));
    for (int d = 0; d < n; ++d) {
      Name name{};
      std::size_t length = 0;
      check(nc_inq_dim(from_, d, name.data(), &length));
      // Classic files have one dimension that grows, the first of its variables.
      const bool grows = std::ranges::find(endless, d) != endless.end() && std::string_view(name.data()) == "time_step";
      int made = -1;
      check(nc_def_dim(to_, name.data(), grows ? NC_UNLIMITED : length, &made));
      if (made != d) throw Error(name_ + ": has dimensions that cannot be kept (damaged file)");
      lengths_.push_back(length);
    }
  }

  void attributes(int from, int to, int n) {
    for (int a = 0; a < n; ++a) {
      Name name{};
      check(nc_inq_attname(from_, from, a, name.data()));
      nc_type type = NC_NAT;
      std::size_t length = 0;
      check(nc_inq_att(from_, from, name.data(), &type, &length));
      if (type > NC_UINT64 || name[0] == '_') continue;  // texts of HDF5, and what the library says of its own
      check(nc_copy_att(from_, from, name.data(), to_, to));
    }
  }

  struct Variable {
    nc_type type = NC_NAT;
    std::vector<int> dimensions;
  };

  void define(int v) {
    Name name{};
    Variable variable;
    int n = 0, n_attributes = 0, made = -1;
    check(nc_inq_varndims(from_, v, &n));
    variable.dimensions.resize(static_cast<std::size_t>(n));
    check(nc_inq_var(from_, v, name.data(), &variable.type, &n, variable.dimensions.data(), &n_attributes));
    if (variable.type > NC_UINT64) throw Error(name_ + ": variable " + name.data() + " is of a type of its own");
    check(nc_def_var(to_, name.data(), variable.type, n, variable.dimensions.data(), &made));
    if (made != v) throw Error(name_ + ": has variables that cannot be kept (damaged file)");
    attributes(v, v, n_attributes);
    variables_.push_back(std::move(variable));
  }

  /// In pieces along the first dimension.
  void copy(int v) {
    const Variable& variable = variables_[static_cast<std::size_t>(v)];
    std::size_t bytes = 0;
    check(nc_inq_type(from_, variable.type, nullptr, &bytes));
    std::vector<std::size_t> start(std::max<std::size_t>(1, variable.dimensions.size()), 0), count(start.size(), 1);
    std::size_t row = bytes;
    for (std::size_t d = 0; d < variable.dimensions.size(); ++d) {
      count[d] = lengths_[static_cast<std::size_t>(variable.dimensions[d])];
      if (d > 0 && __builtin_mul_overflow(row, count[d], &row)) throw std::bad_alloc();
    }
    const std::size_t n = count[0], most = row == 0 ? n : std::max<std::size_t>(1, piece_bytes / row);
    if (row == 0) return;
    buffer_.resize(std::max(buffer_.size(), std::min(n, most) * row));
    for (; start[0] < n; start[0] += count[0]) {
      count[0] = std::min(most, n - start[0]);
      check(nc_get_vara(from_, v, start.data(), count.data(), buffer_.data()));
      check(nc_put_vara(to_, v, start.data(), count.data(), buffer_.data()));
    }
  }

  const std::string name_;
  int from_ = -1, to_ = -1;  // closed with the process
  std::vector<std::size_t> lengths_;
  std::vector<Variable> variables_;
  std::vector<char> buffer_;
};

}  // namespace
}  // namespace hextwist::app

int main(int argc, char** argv) {
  _exit(hextwist::serve_fenced(argc, argv, [](const hextwist::FencedJob& job) { hextwist::app::Copy(job).run(); }));
}
