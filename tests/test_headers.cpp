// See tests/CMakeLists.txt: carries the precompiled header of the tests.
