// What sanitizers say that is no fault of ours.
//
// Leaks: what libraries of others forget at the end of a program: OpenCASCADE's tables of STEP and IGES, made once, and
// eight bytes of CGNS for each file in HDF5 that is none of its own (cg_version). Whether the leak checker sees them
// depends on what is left in registers.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libTK\nleak:libcgns\n";
}

// Races: a page behind the end of a file that was cut off is exchanged for one of zeros (io/mapped.cpp) while other
// threads read there. The kernel does that at once; the sanitizer takes it for a write.
extern "C" const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions() {
  return "race:on_bus_error\n";
}
