// What the shared library shows: the installed headers open their namespace as `namespace HEXTWIST_API hextwist {`, and
// everything declared there is seen from outside. All else is hidden.
#pragma once

#ifdef __GNUC__
/// Of a namespace: what is declared there can be called from outside of the shared library. Not for use elsewhere.
#define HEXTWIST_API [[gnu::visibility("default")]]
#else
#define HEXTWIST_API
#endif
