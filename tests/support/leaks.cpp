// What libraries of others forget at the end of a program, which is no leak of ours: OpenCASCADE's tables of STEP and
// IGES, made once, and eight bytes of CGNS for each file in HDF5 that is none of its own (cg_version). Whether the leak
// checker sees them depends on what is left in registers.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libTK\nleak:libcgns\n";
}
