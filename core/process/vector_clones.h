#pragma once

/// Put before a function of loops over plain arrays: it is compiled for the plain instruction set, AVX2 and AVX-512
/// (without fused multiply-add), and the program chooses when it starts. Each operation rounds alike in both, so the
/// bits do not depend on the choice. Such functions must not handle Eigen types, whose layout depends on the
/// instruction set. With clang there is one version, the plain one: clang 14 makes nothing but the AVX-512 version of a
/// function that was declared before in a namespace, and the program then dies on processors without it.
#if defined(__x86_64__) && defined(__linux__) && !defined(__clang__)
#define CANYON_VECTOR_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define CANYON_VECTOR_CLONES
#endif
