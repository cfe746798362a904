"""The colors of poses in all pictures: plots, animations, RViz (rviz/*.rviz) and the browser (web/style.css).

With simulated protanopia, deuteranopia and tritanopia (Machado et al. 2009), two of them differ by at least 23 in
CIELAB. On the backgrounds of all pictures, their contrast is at least 3.
"""
TRUTH = '#267dff'       # blue
ODOMETRY = '#f21000'    # red
ESTIMATE = '#00a64d'    # green
