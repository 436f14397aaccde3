# gnuplot -e "folder='out/bench'" growth.gp: draws what growth_bench wrote there.
set terminal pngcairo size 900,560 font "DejaVu Sans,12"
set grid
set key top left
set yrange [0:*]
set ylabel "CPU seconds per second of capture"

set output folder."/growth_cameras.png"
data = folder."/growth_cameras.dat"
set title "Reception against the number of cameras (640x480, 30 Hz)"
set xlabel "cameras"
set xrange [0:*]
line(x) = offset + slope * x
set fit quiet nolog
fit line(x) data index 0 using 1:2 via offset, slope
plot data index 0 using 1:2 with points pt 7 ps 1.3 lc rgb "#c03028" title "kagami", \
     line(x) with lines lc rgb "#c03028" title sprintf("kagami: %.1f ms + %.2f ms per camera", offset * 1e3, slope * 1e3), \
     data index 1 using 1:2 with points pt 6 ps 1.3 lc rgb "#404040" title "minimal Aravis client"

set output folder."/growth_history.png"
data = folder."/growth_history.dat"
set title "Reception against the history's length (8 cameras, 640x480, 30 Hz)"
set xlabel "frames kept per camera"
plot data index 0 using 1:2 with linespoints pt 7 ps 1.3 lc rgb "#c03028" title "kagami"
