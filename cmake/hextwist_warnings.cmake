# Warnings for our own targets. -Wno-... entries are noise from templates of the libraries instantiated in our sources.
function(hextwist_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                         -Wnon-virtual-dtor -Woverloaded-virtual -Wno-psabi
                         $<$<BOOL:${HEXTWIST_WARNINGS_AS_ERRORS}>:-Werror>)
endfunction()
