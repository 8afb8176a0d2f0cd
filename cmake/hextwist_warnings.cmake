# Warnings for our own targets. -Wno-... entries are noise from templates of the libraries instantiated in our sources.
function(hextwist_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                         -Wnon-virtual-dtor -Woverloaded-virtual -Wno-psabi
                         $<$<BOOL:${HEXTWIST_WARNINGS_AS_ERRORS}>:-Werror>)
  # g++ 12 is wrong about std::string; clang-tidy would not know the word.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT HEXTWIST_TIDY)
    target_compile_options(${target} PRIVATE -Wno-restrict -Wno-array-bounds -Wno-stringop-overflow)
  endif()
endfunction()
