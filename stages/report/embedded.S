// SPDX-License-Identifier: GPL-3.0-or-later
// The page as it stands in page/, inside the program; its script is all of the modules,
// one behind the other.
    .section .rodata
    .macro begin label
    .global \label
\label:
    .endm
    .macro part file
    .incbin "stages/report/page/\file"
    .endm

    begin page_template
    part page.html
    .byte 0

    begin page_style
    part style.css
    .byte 0

    begin page_script
    part numbers.js
    part data.js
    part groups.js
    part motion.js
    part fields.js
    part camera.js
    part shaders.js
    part visible.js
    part scene.js
    part flat.js
    part slider.js
    part curves.js
    part details.js
    part main.js
    .byte 0

    begin study_template
    part study.html
    .byte 0

    begin study_script
    part study.js
    .byte 0

    .section .note.GNU-stack, "", @progbits
