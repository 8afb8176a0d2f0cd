// Between numpy and flat arrays, and from records to dictionaries.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <span>
#include <string>
#include <vector>

#include "hextwist/session/session.h"

namespace hextwist::python {

namespace py = pybind11;

/// Text of users need not be UTF-8.
inline py::str text(const std::string& bytes) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "replace"));
}

/// A read-only array of n rows of S that shows memory which `owner` keeps: width 0: one-dimensional.
template <class S>
py::array view(const S* values, std::size_t n, std::size_t width, const py::object& owner) {
  std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(n)};
  if (width > 0) shape.push_back(static_cast<py::ssize_t>(width));
  py::array_t<S> array(shape, n > 0 ? values : nullptr, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// The list's items as rows of S: Hex as 8 Index, Vec3 as 3 double, ...
template <class S, class List>
py::array rows(const List& list, const py::object& owner) {
  using T = std::remove_cvref_t<decltype(list[0])>;
  static_assert(sizeof(T) % sizeof(S) == 0);
  constexpr std::size_t width = sizeof(T) / sizeof(S);
  return view(reinterpret_cast<const S*>(list.data()), list.size(), std::is_same_v<T, S> ? 0 : width, owner);
}

/// A vector of its own becomes an array without a copy.
template <class T>
py::array_t<T> array_of(std::vector<T> values) {
  auto* kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* vector) { delete static_cast<std::vector<T>*>(vector); });
  return py::array_t<T>(static_cast<py::ssize_t>(kept->size()), kept->data(), owner);
}

/// What numpy takes for an array of numbers. Throws TypeError naming it.
inline py::array numbers(const py::object& given, const char* name) {
  const py::array array = py::array::ensure(given);
  const char kind = array ? array.dtype().kind() : ' ';
  if (kind != 'i' && kind != 'u' && kind != 'b' && kind != 'f')
    throw py::type_error(std::string(name) + ": an array of numbers is wanted" +
                         (array ? ", not of " + std::string(py::str(array.dtype())) : ""));
  return array;
}

/// Anything that numpy takes for an array of that many columns (0: one-dimensional). Throws ValueError or TypeError
/// naming it.
inline py::array checked(const py::object& given, const char* name, py::ssize_t width) {
  const py::array array = numbers(given, name);
  const bool empty = array.size() == 0;
  const bool fits = width == 0 ? array.ndim() == 1 : array.ndim() == 2 && array.shape(1) == width;
  if (!fits && !empty)
    throw py::value_error(std::string(name) + ": an array of shape (n" +
                          (width == 0 ? std::string(",") : ", " + std::to_string(width)) + ") is wanted");
  return array;
}

using Int64Array = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

/// Throws ValueError where an unsigned integer has no place among signed ones.
inline void check_sign(const py::array& given, const Int64Array& signed_ones, const char* name) {
  if (given.dtype().kind() != 'u') return;
  for (py::ssize_t i = 0; i < signed_ones.size(); ++i)
    if (signed_ones.data()[i] < 0)
      throw py::value_error(std::string(name) + ": " +
                            std::to_string(static_cast<std::uint64_t>(signed_ones.data()[i])) + " is too large");
}

/// Integers beyond 2^53, which doubles do not tell from their neighbours, are refused.
inline std::vector<double> doubles(const py::object& given, const char* name, py::ssize_t width) {
  const py::array of = checked(given, name, width);
  if (const char kind = of.dtype().kind(); (kind == 'i' || kind == 'u') && of.itemsize() == 8) {
    constexpr std::int64_t most = std::int64_t{1} << 53;
    const auto wide = Int64Array::ensure(of);
    if (!wide) throw py::type_error(std::string(name) + ": an array of numbers is wanted");
    check_sign(of, wide, name);
    for (py::ssize_t i = 0; i < wide.size(); ++i)
      if (wide.data()[i] > most || wide.data()[i] < -most)
        throw py::value_error(std::string(name) + ": " + std::to_string(wide.data()[i]) +
                              " can't be kept: values are doubles, which are exact up to 2**53");
  }
  const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(of);
  if (!array) throw py::type_error(std::string(name) + ": an array of numbers is wanted");
  return {array.data(), array.data() + array.size()};
}

/// Integers that fit T; floats are refused rather than cut.
template <class T>
std::vector<T> integers(const py::object& given, const char* name, py::ssize_t width) {
  const py::array array = checked(given, name, width);
  if (const char kind = array.dtype().kind(); array.size() > 0 && kind != 'i' && kind != 'u' && kind != 'b')
    throw py::type_error(std::string(name) + ": integers are wanted, not " + std::string(py::str(array.dtype())));
  const auto wide = Int64Array::ensure(array);
  if (!wide) throw py::type_error(std::string(name) + ": an array of integers is wanted");
  check_sign(array, wide, name);
  std::vector<T> result(static_cast<std::size_t>(wide.size()));
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = static_cast<T>(wide.data()[i]);
    if (result[i] != wide.data()[i])
      throw py::value_error(std::string(name) + ": " + std::to_string(wide.data()[i]) + " is too large");
  }
  return result;
}

}  // namespace hextwist::python
