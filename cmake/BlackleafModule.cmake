# How every target of the project is compiled, and how a module is declared.

add_library(blackleaf_settings INTERFACE)
target_compile_features(blackleaf_settings INTERFACE cxx_std_20)
# No contraction of a*b+c: the same source gives the same bits with every compiler and instruction set.
target_compile_options(blackleaf_settings INTERFACE -ffp-contract=off)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  # popcnt and SSE4.2, in every x86-64 processor since 2009.
  target_compile_options(blackleaf_settings INTERFACE -march=x86-64-v2)
endif()

add_library(blackleaf_warnings INTERFACE)
target_compile_options(blackleaf_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor -Wcast-align -Wold-style-cast
  $<$<BOOL:${BLACKLEAF_WERROR}>:-Werror>)

# blackleaf_module(NAME sources... [PUBLIC targets...] [PRIVATE targets...])
# A static library blackleaf_NAME, alias blackleaf::NAME. Public headers are in include/, private ones beside the sources.
function(blackleaf_module name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "PUBLIC;PRIVATE")
  add_library(blackleaf_${name} STATIC ${arg_UNPARSED_ARGUMENTS})
  add_library(blackleaf::${name} ALIAS blackleaf_${name})
  set_target_properties(blackleaf_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(blackleaf_${name}
    PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(blackleaf_${name}
    PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE} $<BUILD_INTERFACE:blackleaf_settings> $<BUILD_INTERFACE:blackleaf_warnings>)
  target_compile_features(blackleaf_${name} PUBLIC cxx_std_20)
endfunction()
