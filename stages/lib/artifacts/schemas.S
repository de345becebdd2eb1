// SPDX-License-Identifier: GPL-3.0-or-later
// The schemas, as they stand in schemas/, inside every program.
    .section .rodata
    .macro schema label, file
    .global \label
\label:
    .incbin "\file"
    .byte 0
    .endm

    schema schema_packing, "schemas/packing.json"
    schema schema_network, "schemas/network.json"
    schema schema_drying, "schemas/drying.json"
    schema schema_forces, "schemas/forces.json"
    schema schema_response, "schemas/response.json"
    schema schema_crackstats, "schemas/crackstats.json"
    schema schema_engine, "schemas/engine.json"
    schema schema_restart, "schemas/restart.json"
    schema schema_bridge, "schemas/bridge.json"
    schema schema_flow, "schemas/flow.json"
    schema schema_invasion, "schemas/invasion.json"
    schema schema_check, "schemas/check.json"
    schema schema_motion, "schemas/motion.json"
    schema schema_shearstats, "schemas/shearstats.json"
    schema schema_rings, "schemas/rings.json"

    .section .note.GNU-stack, "", @progbits
