# Read by builds of tests, behind their `project(…)`: what is alike in many components is compiled once for all tests (see
# kept_objects.py).
function(keep)
  get_property(targets DIRECTORY PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    if(NOT type STREQUAL "UTILITY")
      set_target_properties(${target} PROPERTIES CXX_COMPILER_LAUNCHER "${KEPT_OBJECTS}")
      target_compile_options(${target} PRIVATE "-fmacro-prefix-map=${CMAKE_SOURCE_DIR}=.")
    endif()
  endforeach()
endfunction()
cmake_language(DEFER CALL keep)
